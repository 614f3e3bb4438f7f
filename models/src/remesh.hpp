#pragma once

#include <cstdint>

#include "implicit_surface.hpp"
#include "supple/mesh.hpp"

namespace supple::models {

/// Collapses the shortest edges, measured against the surface's own edge length, until `vertex_count` are
/// left; the rest is renumbered without gaps. The mesh must be a closed manifold and stays one of the same
/// genus. O(n log n). Ties go to the lower ids.
void collapse_edges(TriangleMesh& mesh, const ImplicitSurface& surface, std::uint32_t vertex_count);

/// Evens out the triangles of a closed mesh near the surface: flips edges that face large angles, centres
/// vertices among their neighbours, and puts them back on the surface. Counts and genus stay.
void even_out(TriangleMesh& mesh, const ImplicitSurface& surface, std::uint32_t rounds);

/// The surface with exactly so many vertices, its triangles even; their number follows from the genus.
TriangleMesh triangulate_with(const ImplicitSurface& surface, double cell, std::uint32_t vertex_count);

}  // namespace supple::models
