#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "octree/octree_node.hpp"
#include "supple/options.hpp"
#include "supple/types.hpp"

namespace supple {

/// Nodes of an octree and the order of its primitives.
struct OctreeTopology {
  std::vector<OctreeNode> nodes;           ///< level by level; empty when there are no primitives
  std::vector<std::uint32_t> order;        ///< primitive at each place of the octree's order
  std::vector<std::uint32_t> level_begin;  ///< first node of each level, then the number of nodes
};

/// Builds the paper's regular octree top-down over points (the centres of triangles), in O(n log n). A point
/// that is not finite counts as the lower corner of the others. Equal points cannot be split and may leave a
/// leaf larger than `leaf_size`.
OctreeTopology build_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options);

}  // namespace supple
