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
/// the positions are complete; `fans` are those of `add_face`, and every id must exist. See `PolygonCutter`.
void cut_polygons(TriangleMesh& mesh, std::span<const PolygonFan> fans);

}  // namespace supple
