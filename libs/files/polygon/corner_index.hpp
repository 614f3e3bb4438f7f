#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "files/polygon/outline_view.hpp"

namespace supple {

/// Finds corners in a triangle by a k-d tree. It keeps its memory from one polygon to the next.
class CornerIndex {
 public:
  /// Starts with no corner. The view must outlive the index.
  void start(const OutlineView& view);
  void insert(std::uint32_t corner) { set(corner, true); }
  void remove(std::uint32_t corner) { set(corner, false); }

  /// Calls `visit(corner)` for corners that may lie in the closed triangle, among them all that do, until it
  /// returns true. It may leave out those at the places of corners that are clear. The triangle turns left.
  template <class Visit>
  void search(const std::array<std::uint32_t, 3>& triangle, const std::array<bool, 3>& is_clear,
              Visit visit) const {
    // Each step replaces one node by two of the next level, and the tree has at most 32 levels.
    std::array<std::uint32_t, 33> stack{0};
    for (std::size_t size = 1; size > 0;) {
      const Node& node = nodes_[stack[--size]];
      if (node.inserted == 0 || !may_overlap(node, triangle)) continue;
      if (node.low == node.high && is_at_clear(node, triangle, is_clear)) continue;
      if (node.left == 0) {
        for (std::uint32_t i = node.first; i < node.last; ++i) {
          if (inserted_[corners_[i]] && visit(corners_[i])) return;
        }
      } else {
        stack[size++] = node.left + 1;
        stack[size++] = node.left;
      }
    }
  }

 private:
  struct Node {
    std::array<double, 2> low, high;
    std::uint32_t parent;
    std::uint32_t first, last;   ///< of its corners in `corners_`
    std::uint32_t left = 0;      ///< the right child follows; 0: a leaf
    std::uint32_t inserted = 0;  ///< how many of its corners are inserted
  };
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  void set(std::uint32_t corner, bool inserted);
  void split(std::uint32_t node);
  bool is_at_clear(const Node& node, const std::array<std::uint32_t, 3>& triangle,
                   const std::array<bool, 3>& is_clear) const;
  bool may_overlap(const Node& node, const std::array<std::uint32_t, 3>& triangle) const;

  const OutlineView* view_ = nullptr;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> corners_, leaf_;  ///< the corners by leaf, and the leaf of each corner
  std::vector<bool> inserted_;
};

}  // namespace supple
