#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "supple/types.hpp"

namespace supple {

/// Three vertex ids, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A triangle soup with shared vertices. No manifoldness is asked for: holes, flaps, duplicate and zero-area
/// triangles, triangles with a repeated id and vertices that no triangle uses are all fine.
struct TriangleMesh {
  std::string name;                 ///< shown in messages and results; the file's stem when loaded
  std::vector<Vec3d> positions;     ///< any doubles; non-finite ones make their triangles inert
  std::vector<Triangle> triangles;  ///< each id must be below positions.size()
};

/// Reads an OBJ, OFF, PLY (ASCII, little or big endian, float or double) or STL (ASCII or binary) file, told
/// by its extension whatever the case.
///
/// Coordinates keep the file's precision, ids its order: vertex i is the file's i-th vertex, polygons become
/// fans around their first corner in file order, texture and normal ids are ignored, unused vertices stay.
/// STL has no ids: corners with equal coordinates become one vertex, numbered by first use.
/// Throws `Error` naming file, line or byte, the value and what is allowed.
TriangleMesh load_mesh(const std::filesystem::path& path);

/// Writes by extension: .obj, .off, .ply (binary little endian, double), .stl (binary, single precision).
/// Text formats print the shortest digits that read back to the same double. Throws `Error`.
void save_mesh(const TriangleMesh& mesh, const std::filesystem::path& path);

/// Throws `Error` naming mesh, triangle and value when a triangle uses a vertex that does not exist.
void check_mesh(const TriangleMesh& mesh);

}  // namespace supple
