#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "geometry/aabb.hpp"
#include "narrow_phase/traversal.hpp"

namespace supple {

/// The descent of a query into one octree, nearest children first. Holds the stack of one worker, kept
/// between calls.
class OrderedDescent {
 public:
  /// Calls `on_leaf(leaf, begin, end)` with the leaves whose boxes have a bound of at most `limit()`: eight
  /// times the node plus the child, and the range of triangles in octree order. `bound_children(node,
  /// bounds)` writes the bounds of the children of a node. The bound of a box must be at most that of every
  /// part of it. Skips children without a finite triangle. `limit()` may decrease during the descent.
  template <class BoundChildren, class Limit, class OnLeaf>
  void run(const OctreeView& view, const BoundChildren& bound_children, const Limit& limit,
           const OnLeaf& on_leaf) {
    stack_.clear();
    if (!view.nodes.empty()) expand(view, 0, bound_children, limit());
    while (!stack_.empty()) {
      const Entry entry = stack_.back();
      stack_.pop_back();
      if (!(entry.bound <= limit())) continue;
      const OctreeNode& node = view.nodes[entry.node];
      if (node.is_inner(entry.child)) {
        expand(view, node.child_node(entry.child), bound_children, limit());
      } else {
        on_leaf(node_width * entry.node + static_cast<std::uint32_t>(entry.child),
                node.first_triangle[entry.child], node.first_triangle[entry.child + 1]);
      }
    }
  }

 private:
  struct Entry {
    double bound;
    std::uint32_t node;
    int child;
  };

  /// Pushes the children, the nearest last.
  template <class BoundChildren>
  void expand(const OctreeView& view, std::uint32_t node, const BoundChildren& bound_children, double limit) {
    const std::size_t first = stack_.size();
    std::array<double, node_width> bounds;
    bound_children(node, bounds);
    std::uint32_t near = 0;  // without a branch for each child
    for (std::uint32_t i = 0; i < node_width; ++i) near |= (bounds[i] <= limit ? 1u : 0u) << i;
    for (near &= view.nodes[node].child_mask(); near != 0; near &= near - 1) {
      const int child = std::countr_zero(near);
      const double bound = bounds[static_cast<std::size_t>(child)];
      if (view.boxes[node].min_x[child] > view.boxes[node].max_x[child]) continue;  // empty
      std::size_t place = stack_.size();
      stack_.emplace_back();
      for (; place > first && stack_[place - 1].bound < bound; --place) stack_[place] = stack_[place - 1];
      stack_[place] = {bound, node, child};
    }
  }

  std::vector<Entry> stack_;
};

}  // namespace supple
