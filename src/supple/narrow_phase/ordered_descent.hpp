#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/aabb.hpp"
#include "narrow_phase/traversal.hpp"

namespace supple {

/// The descent of a query into one octree, nearest children first. Holds the stack of one worker, kept
/// between calls.
class OrderedDescent {
 public:
  /// Calls `on_leaf(leaf, begin, end)` with the leaves for which `bound_of(box)` is at most `limit()`: eight
  /// times the node plus the child, and the range of triangles in octree order. The bound of a box must be at
  /// most that of every part of it. Skips children without a finite triangle. `limit()` may decrease during
  /// the descent.
  template <class BoundOf, class Limit, class OnLeaf>
  void run(const OctreeView& view, const BoundOf& bound_of, const Limit& limit, const OnLeaf& on_leaf) {
    stack_.clear();
    if (!view.nodes.empty()) expand(view, 0, bound_of, limit());
    while (!stack_.empty()) {
      const Entry entry = stack_.back();
      stack_.pop_back();
      if (!(entry.bound <= limit())) continue;
      const OctreeNode& node = view.nodes[entry.node];
      if (node.is_inner(entry.child)) {
        expand(view, node.child_node(entry.child), bound_of, limit());
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
  template <class BoundOf>
  void expand(const OctreeView& view, std::uint32_t node, const BoundOf& bound_of, double limit) {
    const std::size_t first = stack_.size();
    for (int child = 0; child < view.nodes[node].child_count; ++child) {
      const Aabb box = child_box(view.boxes[node], child);
      if (box.empty()) continue;
      const double bound = bound_of(moved(box, view.translation));
      if (bound <= limit) stack_.push_back({bound, node, child});
    }
    std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(first), stack_.end(),
              [](const Entry& a, const Entry& b) { return a.bound > b.bound; });
  }

  std::vector<Entry> stack_;
};

}  // namespace supple
