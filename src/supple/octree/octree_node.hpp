#pragma once

#include <cstdint>

#include "geometry/aabb.hpp"
#include "supple/types.hpp"

namespace supple {

/// Most children of a node.
constexpr int node_width = 8;

/// The number of ones in the low eight bits. `std::popcount` is a function call for machines that may lack
/// the instruction.
constexpr std::uint32_t bit_count(std::uint32_t bits) {
  bits -= bits >> 1 & 0x55u;
  bits = (bits & 0x33u) + (bits >> 2 & 0x33u);
  return (bits + (bits >> 4)) & 0x0fu;
}

/// The boxes of the children of a node, one array per axis and side: one box against eight takes six vector
/// comparisons. Missing children have inverted boxes. Rounded outward.
struct alignas(64) ChildBoxes {
  float min_x[node_width], min_y[node_width], min_z[node_width];
  float max_x[node_width], max_y[node_width], max_z[node_width];
};

/// Empty if the child is missing.
inline Aabb child_box(const ChildBoxes& boxes, int child) {
  return {{boxes.min_x[child], boxes.min_y[child], boxes.min_z[child]},
          {boxes.max_x[child], boxes.max_y[child], boxes.max_z[child]}};
}

inline void set_child_box(ChildBoxes& boxes, int child, const Aabb& box) {
  boxes.min_x[child] = box.min.x;
  boxes.min_y[child] = box.min.y;
  boxes.min_z[child] = box.min.z;
  boxes.max_x[child] = box.max.x;
  boxes.max_y[child] = box.max.y;
  boxes.max_z[child] = box.max.z;
}

/// The box around all children.
inline Aabb enclosing_box(const ChildBoxes& boxes) {
  Aabb box = child_box(boxes, 0);
  for (int child = 1; child < node_width; ++child) extend(box, child_box(boxes, child));
  return box;
}

/// A node with up to eight children, without its volumes. Child i has the triangles [first_triangle[i],
/// first_triangle[i + 1]) in the octree's order. Nodes of inner children are consecutive, in the order of
/// the children.
struct OctreeNode {
  std::uint32_t first_triangle[node_width + 1];
  std::uint32_t first_child;  ///< node of the first inner child; its siblings follow
  std::uint32_t parent;       ///< node; the root is its own parent
  std::uint8_t inner_mask;    ///< bit i: child i is a node, not a leaf
  std::uint8_t child_count;   ///< 1 to 8; children from here on are missing
  std::uint8_t index_in_parent;
  std::uint8_t level;  ///< the root is 0; its children are at level 1

  bool is_inner(int child) const { return (inner_mask >> child & 1) != 0; }
  std::uint32_t child_node(int child) const {
    return first_child + bit_count(inner_mask & ((1u << child) - 1));
  }
  /// The child that contains the triangle, which the node must contain.
  int child_with(std::uint32_t triangle) const {
    int child = 0;
    while (first_triangle[child + 1] <= triangle) ++child;
    return child;
  }
  /// Triangles of the child, and of the whole node.
  std::uint32_t size(int child) const { return first_triangle[child + 1] - first_triangle[child]; }
  std::uint32_t size() const { return first_triangle[node_width] - first_triangle[0]; }
  std::uint32_t child_mask() const { return (1u << child_count) - 1; }
};
static_assert(sizeof(OctreeNode) == 48);

/// Vertex lists of leaves are padded to a multiple of this.
constexpr std::size_t leaf_vertices_step = 4;
/// Kernels prefetch so far ahead, and this many more entries follow all lists, unless these are shorter.
constexpr std::size_t leaf_vertices_ahead = 48;
/// This many more entries follow the corners.
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
  std::size_t ahead = 0;  ///< entries after all lists
};

}  // namespace supple
