#pragma once

#include <cstdint>

#include "implicit_surface.hpp"
#include "supple/mesh.hpp"

namespace supple::models {

/// Collapses the shortest edges, relative to the surface's own edge length, until `vertex_count` vertices
/// are left. Renumbers the rest without gaps. The mesh must be a closed manifold; it stays one and keeps its
/// genus. O(n log n). Ties go to the lower ids.
void collapse_edges(TriangleMesh& mesh, const ImplicitSurface& surface, std::uint32_t vertex_count);

/// Improves the triangles of a closed mesh near the surface: flips edges opposite to large angles, moves
/// vertices to the centre of their neighbours, and projects them back to the surface. Counts and genus do
/// not change.
void even_out(TriangleMesh& mesh, const ImplicitSurface& surface, std::uint32_t rounds);

/// Triangulates with exactly `vertex_count` vertices and even triangles. The genus determines the number of
/// triangles.
TriangleMesh triangulate_with(const ImplicitSurface& surface, double cell, std::uint32_t vertex_count);

}  // namespace supple::models
