#pragma once

#include <cstddef>
#include <cstdint>

#include "mesh/vertex_arrays.hpp"
#include "octree/octree_node.hpp"

namespace supple {

/// Vertex lists of leaves are padded to a multiple of this.
constexpr std::size_t leaf_vertices_step = 4;
/// This many more entries follow all lists: kernels prefetch so far ahead.
constexpr std::size_t leaf_vertices_ahead = 48;
/// This many more entries follow each array of corners.
constexpr std::size_t corners_ahead = 16;

/// The distinct vertices of each leaf. Those of child i of node n are `vertices[first[8 n + i]]` up to
/// `vertices[first[8 n + i + 1]]`; the last one fills the padding. Inner and missing children have none.
///
/// The corners of triangle t, as places in its leaf's list modulo 256, are `corners[t]`, `corners[t +
/// stride]` and `corners[t + 2 stride]`.
struct LeafVertexArrays {
  const std::uint32_t* first = nullptr;
  const std::uint32_t* vertices = nullptr;
  const std::uint8_t* corners = nullptr;
  std::size_t stride = 0;
};

/// Computes the boxes of all leaves of the nodes [begin, end), and writes the box of each of these nodes into
/// its parent. The boxes of inner children must be there already. Nodes of one level may run in any order and
/// in parallel.
///
/// Returns false when a vertex is not finite, and possibly when coordinates are so large that their sums
/// overflow; then the boxes are invalid. With `arrays.inert`, inert triangles are left out and all others
/// count as finite. Chooses the widest instruction set at run time; the boxes are equal on all.
bool refit_boxes(const OctreeNode* nodes, ChildBoxes* boxes, const TriangleArrays& arrays,
                 const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end);

}  // namespace supple
