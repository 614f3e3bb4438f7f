#pragma once

#include <cstdint>

#include "supple/mesh.hpp"

namespace supple {

/// How the triangles of a mesh hang together, by vertex ids alone; coordinates do not matter.
///
/// Triangles that repeat an id span nothing: they are counted as degenerate and otherwise left out, so all
/// other numbers are those of the mesh without them.
struct MeshTopology {
  std::uint64_t vertices = 0;              ///< all of the mesh, used or not
  std::uint64_t unused_vertices = 0;       ///< of no triangle
  std::uint64_t triangles = 0;             ///< all of the mesh, degenerate ones too
  std::uint64_t degenerate_triangles = 0;  ///< with an id twice or three times
  std::uint64_t edges = 0;                 ///< distinct, without direction
  std::uint64_t boundary_edges = 0;        ///< of exactly one triangle
  std::uint64_t non_manifold_edges = 0;    ///< of more than two triangles
  std::uint64_t components = 0;            ///< pieces of triangles that share vertices
  std::int64_t euler_characteristic = 0;   ///< used vertices - edges + triangles

  /// True when there are triangles and no edge is a border.
  bool closed() const { return edges != 0 && boundary_edges == 0; }
};

/// Counts the above in O(n log n) time for n triangles. Throws `Error` as `check_mesh` does.
MeshTopology compute_topology(const TriangleMesh& mesh);

}  // namespace supple
