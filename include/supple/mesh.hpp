#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "supple/types.hpp"

namespace supple {

/// Three vertex ids, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// The faces of a mesh file with more than three corners, before they became triangles.
struct PolygonCounts {
  std::uint64_t quads = 0;     ///< with four corners
  std::uint64_t larger = 0;    ///< with five corners or more
  std::uint64_t concave = 0;   ///< polygons that turn both ways
  std::uint64_t crossing = 0;  ///< polygons whose outline crosses itself
  /// Polygons with a corner farther from the mean plane of the corners than 1/1000 of the size.
  std::uint64_t bent = 0;

  bool operator==(const PolygonCounts&) const = default;
};

/// A triangle soup with shared vertices. It need not be a manifold: holes, flaps, duplicate and zero-area
/// triangles, triangles with a repeated id and unused vertices are all allowed. It can also have edges and
/// points of no triangle, for example rods and particles.
struct TriangleMesh {
  std::string name;                 ///< for messages and results; the stem of the file name when loaded
  std::vector<Vec3d> positions;     ///< any doubles; non-finite ones make their triangles inert
  std::vector<Triangle> triangles;  ///< each id must be below positions.size()
  /// Edges and points of no triangle, as vertex ids; `Scene::add` adds them to those of its options. See
  /// `ObjectOptions::edges`.
  std::vector<std::array<std::uint32_t, 2>> edges{};
  std::vector<std::uint32_t> points{};
  PolygonCounts polygons{};  ///< of the file; changes nothing in a scene
};

/// Throws `Error` when a triangle, an edge or a point uses a vertex that does not exist, and when both ends
/// of an edge are the same vertex; the message names the mesh, the place in its list, and the value.
void check_mesh(const TriangleMesh& mesh);

}  // namespace supple
