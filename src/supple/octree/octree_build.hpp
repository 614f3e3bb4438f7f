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

/// Regular top-down octree over points (the centres of triangles), in O(n log n). Non-finite points are taken
/// as the lower corner of the rest. Equal points cannot be split and may leave a leaf larger than
/// `leaf_size`. `first_level` is that of the root in the tree that it becomes a part of; nodes count from 0.
OctreeTopology build_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options,
                            std::uint32_t first_level = 0);

}  // namespace supple
