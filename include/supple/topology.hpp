#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/views.hpp"

namespace supple {

/// How the triangles of a mesh are connected, by vertex ids alone; coordinates do not matter.
///
/// A triangle that repeats an id is counted as degenerate. All other numbers are those of the mesh without
/// degenerate triangles.
struct MeshTopology {
  std::uint64_t vertices = 0;              ///< all vertices, used or not
  std::uint64_t unused_vertices = 0;       ///< in no triangle
  std::uint64_t triangles = 0;             ///< all triangles, including degenerate ones
  std::uint64_t degenerate_triangles = 0;  ///< with a repeated id
  std::uint64_t edges = 0;                 ///< distinct, undirected
  std::uint64_t boundary_edges = 0;        ///< in exactly one triangle
  std::uint64_t odd_edges = 0;             ///< in an odd number of triangles; these leave the surface open
  std::uint64_t non_manifold_edges = 0;    ///< in more than two triangles
  std::uint64_t components = 0;            ///< sets of triangles connected by shared vertices
  std::int64_t euler_characteristic = 0;   ///< used vertices - edges + triangles

  /// True when there are edges and each is in an even number of triangles, so that every point has a side.
  bool closed() const { return edges != 0 && odd_edges == 0; }
};

/// Counts in O(n log n) time for n triangles. Throws `Error` as `check_mesh` does.
MeshTopology compute_topology(const TriangleMesh& mesh);

/// The surface in words, for messages and tables: `closed`, `open, 4 boundary edges`.
std::string describe_surface(const MeshTopology& topology);

/// For each vertex the first one with the same coordinates. Equals `ObjectOptions::same_vertex` of
/// `ObjectOptions::weld`. A vertex with a NaN has no equal. O(n).
std::vector<std::uint32_t> vertices_at_same_position(PositionsView positions);

/// The mesh with the first of the vertices at the same position in place of all: what `ObjectOptions::weld`
/// makes of it. Vertices keep their numbers. O(n).
TriangleMesh welded(TriangleMesh mesh);

/// Whether most of the edges that leave the surface open are seams: welded, fewer than half of them stay.
/// Exports of renderers split vertices for texture coordinates and normals. O(n log n).
bool is_open_at_seams(const TriangleMesh& mesh);

/// How to close a surface that is open, as a clause for messages: close the holes, or weld the seams.
std::string advice_for_open_surface(const TriangleMesh& mesh);

/// The pairs of triangles with a common vertex, which `Neighbours::skip` does not test. O(n log n).
std::uint64_t count_neighbour_pairs(std::span<const Triangle> triangles);

/// A connected part of a mesh, as a mesh with ids of its own.
struct MeshPart {
  /// Vertices, triangles, edges and points in the order of the whole mesh; the name is that of the mesh.
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertices;   ///< the vertex of the whole mesh, by vertex of the part
  std::vector<std::uint32_t> triangles;  ///< the triangle of the whole mesh, by triangle of the part
};

/// Splits a mesh into its connected parts, ordered by their smallest vertices: triangles and edges that share
/// a vertex id are connected, and a point alone is a part. Vertices that nothing uses are in no part. With
/// `weld`, vertices with equal positions are connected too, so that a split seam joins; they stay apart in
/// the part, so give `ObjectOptions::weld` to its object. O(n). Throws `Error` as `check_mesh` does.
std::vector<MeshPart> split_into_parts(const TriangleMesh& mesh, bool weld = false);

/// Why a surface does not bound a solid (`ObjectOptions::solid`): it is not closed, or its triangles are not
/// oriented alike. Names the first of its faulty edges, and how to correct them, as a clause; the empty
/// string when every edge has as many triangles in one direction as in the other. The vertex ids must be
/// valid. O(n log n).
std::string fault_of_solid(const TriangleMesh& mesh);

}  // namespace supple
