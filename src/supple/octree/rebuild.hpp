#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "octree/octree_build.hpp"
#include "octree/octree_node.hpp"

namespace supple {

/// A node of the new tree that was no node of the tree before.
constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();

/// A subtree rebuilt over the triangles of `node`, which it replaces.
struct NewSubtree {
  std::uint32_t node = 0;
  OctreeTopology topology;
};

/// Nodes level by level, and what each of them was: a node of the tree before that is still there, the one
/// whose place a new subtree's root took, or `no_node`.
struct RelinkedNodes {
  std::vector<OctreeNode> nodes;
  std::vector<std::uint32_t> level_begin, old_nodes;
};

/// Puts new subtrees into the places of old ones; none of these is below another. A subtree of a single lane
/// becomes a leaf of its parent. O(nodes).
RelinkedNodes relink(std::span<const OctreeNode> nodes, std::span<const NewSubtree> subtrees);

}  // namespace supple
