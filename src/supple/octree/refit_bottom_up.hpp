#pragma once

#include <hwy/base.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "octree/octree_node.hpp"

namespace supple {

/// Computes volumes of the nodes [begin, end) of one octree: part of a level, after the levels below it, or
/// all nodes. For each node, the deepest level first, calls
///  1. `leaf(n, child)` for each child of node n that is a leaf: computes its volume from its triangles,
///  2. `unite(n)`: computes the volume of node n from those of its children.
/// Inlined, so that kernels keep their instruction set.
template <class Leaf, class Unite>
HWY_INLINE void refit_bottom_up(const OctreeNode* nodes, std::uint32_t begin, std::uint32_t end,
                                const Leaf& leaf, const Unite& unite) {
  for (std::uint32_t level_begin = begin; end > begin; end = level_begin) {
    const auto* const first =
        std::ranges::lower_bound(nodes + begin, nodes + end, nodes[end - 1].level, {}, &OctreeNode::level);
    level_begin = static_cast<std::uint32_t>(first - nodes);
    for (std::uint32_t n = level_begin; n < end; ++n) {
      const OctreeNode& node = nodes[n];
      for (int child = 0; child < node.child_count; ++child) {
        if (!node.is_inner(child)) leaf(n, child);
      }
      unite(n);
    }
  }
}

/// Sets the boxes of all children of an octree. `box_of_leaf(node, child)` computes the box of a leaf.
template <class BoxOfLeaf>
void refit_child_boxes(std::span<const OctreeNode> nodes, ChildBoxes* boxes, const BoxOfLeaf& box_of_leaf) {
  refit_bottom_up(
      nodes.data(), 0, static_cast<std::uint32_t>(nodes.size()),
      [&](std::uint32_t n, int child) { set_child_box(boxes[n], child, box_of_leaf(nodes[n], child)); },
      [&](std::uint32_t n) {
        for (int child = nodes[n].child_count; child < node_width; ++child)
          set_child_box(boxes[n], child, {});
        if (nodes[n].parent != n)
          set_child_box(boxes[nodes[n].parent], nodes[n].index_in_parent, enclosing_box(boxes[n]));
      });
}

}  // namespace supple
