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

/// Reads an OBJ, OFF, PLY (ASCII, little or big endian, float or double) or STL (ASCII or binary) file. The
/// extension, in either case, selects the format.
///
/// Coordinates keep the precision of the file, and ids keep its order: vertex i is the i-th vertex of the
/// file. Texture and normal ids are ignored. Unused vertices stay. The lines of an OBJ file become edges,
/// n - 1 for a polyline of n vertices, and its points become points; so do the edges of a PLY file. A face of
/// two corners is an edge, and a face of one corner is a point, but not in STL. Faces of OFF and PLY without
/// corners are left out. STL has no ids: corners with equal coordinates become one vertex, numbered by first
/// use.
///
/// A polygon of n corners becomes n - 2 triangles, in file order, that cover the inside of its outline once.
/// They are the fan around its first corner where this fan stays inside, as in convex polygons. The outline
/// is seen along the axis in which its area is the largest; in this view the cut is exact, also for corners
/// on one line and for corners and edges that coincide. The triangles of an outline that crosses itself
/// overlap, or some of them turn the other way; `TriangleMesh::polygons` counts these polygons, and those
/// that are not flat.
///
/// Throws `Error`; the message names the file, the line or byte, the value, and the allowed values.
TriangleMesh load_mesh(const std::string& path);

/// Writes a file in the format of its extension: .obj, .off, .ply (binary little endian, double), .stl
/// (binary, single precision). Text formats print the shortest digits that read back to the same double.
/// Throws `Error` when the extension is unknown, when the file cannot be written, and when the mesh has edges
/// or points of no triangle and the format is not OBJ.
void save_mesh(const TriangleMesh& mesh, const std::string& path);

/// Throws `Error` when a triangle, an edge or a point uses a vertex that does not exist, and when both ends
/// of an edge are the same vertex; the message names the mesh, the place in its list, and the value.
void check_mesh(const TriangleMesh& mesh);

}  // namespace supple
