#pragma once

#include <cstdint>

#include "supple/mesh.hpp"

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
  std::uint64_t non_manifold_edges = 0;    ///< in more than two triangles
  std::uint64_t components = 0;            ///< sets of triangles connected by shared vertices
  std::int64_t euler_characteristic = 0;   ///< used vertices - edges + triangles

  /// True when there are edges and none is a boundary edge.
  bool closed() const { return edges != 0 && boundary_edges == 0; }
};

/// Counts in O(n log n) time for n triangles. Throws `Error` as `check_mesh` does.
MeshTopology compute_topology(const TriangleMesh& mesh);

}  // namespace supple
