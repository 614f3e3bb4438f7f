#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "files/polygon/outline.hpp"

namespace supple {

/// Finds corners in a triangle by a k-d tree.
class CornerIndex {
 public:
  /// Starts with no corner. The view must outlive the index.
  explicit CornerIndex(const OutlineView& view)
      : view_(&view), corners_(view.size()), leaf_(view.size()), inserted_(view.size(), false) {
    std::iota(corners_.begin(), corners_.end(), 0u);
    nodes_.push_back(
        {.low = {}, .high = {}, .parent = none, .first = 0, .last = static_cast<std::uint32_t>(view.size())});
    for (std::uint32_t node = 0; node < nodes_.size(); ++node) split(node);
  }

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
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max(), leaf_size = 8;

  void set(std::uint32_t corner, bool inserted) {
    if (inserted_[corner] == inserted) return;
    inserted_[corner] = inserted;
    for (std::uint32_t node = leaf_[corner]; node != none; node = nodes_[node].parent)
      nodes_[node].inserted += inserted ? 1u : ~0u;
  }

  void split(std::uint32_t index) {
    Node& node = nodes_[index];
    const std::uint32_t first = node.first, last = node.last;
    node.low = node.high = {view_->x(corners_[first]), view_->y(corners_[first])};
    for (std::uint32_t i = first; i < last; ++i) {
      const std::array point{view_->x(corners_[i]), view_->y(corners_[i])};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        node.low[axis] = std::min(node.low[axis], point[axis]);
        node.high[axis] = std::max(node.high[axis], point[axis]);
      }
    }
    const auto begin = corners_.begin();
    if (last - first <= leaf_size) {
      std::sort(begin + first, begin + last);
      for (std::uint32_t i = first; i < last; ++i) leaf_[corners_[i]] = index;
      return;
    }
    // Corners are distinct in this order, so each half is the same set with every standard library.
    const bool by_x = node.high[0] / 2 - node.low[0] / 2 >= node.high[1] / 2 - node.low[1] / 2;
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = by_x ? view_->x(a) : view_->y(a), at_b = by_x ? view_->x(b) : view_->y(b);
      return at_a != at_b ? at_a < at_b : a < b;
    };
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(begin + first, begin + middle, begin + last, less);
    node.left = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({.low = {}, .high = {}, .parent = index, .first = first, .last = middle});
    nodes_.push_back({.low = {}, .high = {}, .parent = index, .first = middle, .last = last});
  }

  bool is_at_clear(const Node& node, const std::array<std::uint32_t, 3>& triangle,
                   const std::array<bool, 3>& is_clear) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_clear[i] && node.low == std::array{view_->x(triangle[i]), view_->y(triangle[i])}) return true;
    }
    return false;
  }

  bool may_overlap(const Node& node, const std::array<std::uint32_t, 3>& triangle) const {
    const auto [a, b, c] = triangle;
    if (std::max({view_->x(a), view_->x(b), view_->x(c)}) < node.low[0] ||
        std::min({view_->x(a), view_->x(b), view_->x(c)}) > node.high[0] ||
        std::max({view_->y(a), view_->y(b), view_->y(c)}) < node.low[1] ||
        std::min({view_->y(a), view_->y(b), view_->y(c)}) > node.high[1])
      return false;
    // Outside when the point of the box that is farthest to the left of an edge is right of it.
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangle[i], to = triangle[(i + 1) % 3];
      const bool rightward = (view_->x(to) > view_->x(from)) == (view_->turn() > 0);
      const bool upward = (view_->y(to) > view_->y(from)) == (view_->turn() > 0);
      Vec3d farthest{};
      farthest[view_->x_axis()] = upward ? node.low[0] : node.high[0];
      farthest[view_->y_axis()] = rightward ? node.high[1] : node.low[1];
      if (view_->side((*view_)[from], (*view_)[to], farthest) < 0) return false;
    }
    return true;
  }

  const OutlineView* view_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> corners_, leaf_;  ///< the corners by leaf, and the leaf of each corner
  std::vector<bool> inserted_;
};

}  // namespace supple
