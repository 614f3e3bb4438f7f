#pragma once

#include <cstdint>

#include "supple/types.hpp"

namespace supple {

/// Lanes of a node: its children; those without triangles are left out.
constexpr int node_width = 8;

/// Of the low eight bits. `std::popcount` is a call where not every machine has the instruction.
constexpr std::uint32_t bit_count(std::uint32_t bits) {
  bits -= bits >> 1 & 0x55u;
  bits = (bits & 0x33u) + (bits >> 2 & 0x33u);
  return (bits + (bits >> 4)) & 0x0fu;
}

/// The boxes of the children of a node, one array per axis and side: one box against eight takes six vector
/// comparisons. Missing children have inverted boxes. Rounded outward.
struct alignas(64) AabbLanes {
  float min_x[node_width], min_y[node_width], min_z[node_width];
  float max_x[node_width], max_y[node_width], max_z[node_width];
};

/// Empty where the child is missing.
inline Aabb lane_box(const AabbLanes& lanes, int lane) {
  return {{lanes.min_x[lane], lanes.min_y[lane], lanes.min_z[lane]},
          {lanes.max_x[lane], lanes.max_y[lane], lanes.max_z[lane]}};
}

/// The spheres of the children of a node. Missing children, and children without a finite triangle, have a
/// negative radius.
struct alignas(64) SphereLanes {
  float x[node_width], y[node_width], z[node_width], radius[node_width];
};

inline BoundingSphere lane_sphere(const SphereLanes& lanes, int lane) {
  return {{lanes.x[lane], lanes.y[lane], lanes.z[lane]}, lanes.radius[lane]};
}

/// A node with up to eight children, without its volumes. Child i has the triangles [first_triangle[i],
/// first_triangle[i + 1]) in the octree's order. Nodes of inner children are consecutive, in the order of
/// the children.
struct OctreeNode {
  std::uint32_t first_triangle[node_width + 1];
  std::uint32_t first_child;  ///< node of the first inner child; its siblings follow
  std::uint32_t parent;       ///< node; the root is its own parent
  std::uint8_t inner_mask;    ///< bit i: child i is a node, not a leaf
  std::uint8_t lane_count;    ///< 1 to 8; children from here on are missing
  std::uint8_t parent_lane;
  std::uint8_t level;  ///< the root is 0; its lanes are at level 1

  bool is_inner(int lane) const { return (inner_mask >> lane & 1) != 0; }
  std::uint32_t child(int lane) const { return first_child + bit_count(inner_mask & ((1u << lane) - 1)); }
  /// Triangles of the lane, and of the whole node.
  std::uint32_t size(int lane) const { return first_triangle[lane + 1] - first_triangle[lane]; }
  std::uint32_t size() const { return first_triangle[node_width] - first_triangle[0]; }
  std::uint32_t lane_mask() const { return (1u << lane_count) - 1; }
};
static_assert(sizeof(OctreeNode) == 48);

}  // namespace supple
