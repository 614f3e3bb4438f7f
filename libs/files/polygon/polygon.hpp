#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/mesh.hpp"

namespace supple {

/// A polygon of a mesh: the triangles of one fan around its first corner, in the list of the mesh.
struct PolygonFan {
  std::size_t first_triangle, corners;
};

/// Adds a face of a file to the mesh: three or more corners as a fan of triangles around the first corner,
/// two as an edge, one as a point. A fan of more than one triangle is added to `fans`. The ids need not exist
/// yet. The face needs at least one corner.
void add_face(TriangleMesh& mesh, std::vector<PolygonFan>& fans, std::span<const std::uint32_t> corners);

/// Replaces fans by triangles inside the outline of their polygon, and counts the polygons in
/// `mesh.polygons`. A polygon with n corners keeps its n - 2 places in the list of triangles. Call this when
/// the positions are complete; `fans` are those of `add_face`, and every id must exist. See `cut_polygon`.
void cut_polygons(TriangleMesh& mesh, std::span<const PolygonFan> fans);

/// What is special about the outline of a polygon.
struct PolygonShape {
  bool concave = false;  ///< it turns both ways; false when it crosses itself
  bool crosses = false;  ///< some points are not once inside or outside: it winds around them another way
  bool bent = false;     ///< a corner is farther from the mean plane than 1/1000 of the polygon's size
};

/// Cuts a polygon of at least three corners into triangles. Writes corners.size() - 2 triangles of corner
/// numbers, which keep the direction of the outline.
///
/// The outline is seen along the axis in which its area is the largest. In this view all verdicts are exact.
/// A polygon whose fan around the first corner stays inside becomes this fan: convex polygons always do.
/// Other polygons are cut by ears. So the triangles cover the inside of the outline once, also when corners
/// lie on one line, when corners or edges coincide, and when edges touch. They may have no area where the
/// polygon has none.
///
/// The sum of the triangles, each with the sign of its turn, is always the winding number of the outline. An
/// outline that crosses itself gets n - 2 triangles, too; some overlap or turn the other way. A polygon with
/// a coordinate that is not finite, or with all corners on one line, becomes the fan of its first corner.
///
/// A convex polygon takes O(n) time, others O(n log n) in practice.
PolygonShape cut_polygon(std::span<const Vec3d> corners, std::span<Triangle> triangles);

}  // namespace supple
