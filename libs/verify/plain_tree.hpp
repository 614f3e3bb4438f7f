#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "supple/queries.hpp"

namespace supple {

/// Whether the boxes are farther apart than the separation along some axis. The factor exceeds the rounding
/// of the differences.
inline bool are_apart(const QueryBox& a, const QueryBox& b, double separation) {
  const double least = separation * (1 + 0x1p-50);
  for (int axis = 0; axis < 3; ++axis) {
    if (a.min[axis] - b.max[axis] > least || b.min[axis] - a.max[axis] > least) return true;
  }
  return false;
}

/// The exact box of points, of which there is at least one, and of two boxes.
inline QueryBox exact_box(std::span<const Vec3d> points) {
  QueryBox box{points[0], points[0]};
  for (const Vec3d& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], p[axis]);
      box.max[axis] = std::max(box.max[axis], p[axis]);
    }
  }
  return box;
}
inline QueryBox united(const QueryBox& a, const QueryBox& b) {
  return exact_box(std::array{a.min, a.max, b.min, b.max});
}

/// The axis of the largest coordinate.
inline int main_axis(const Vec3d& size) {
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// A binary tree of boxes, each split at the median along its longest axis.
class PlainTree {
 public:
  explicit PlainTree(std::vector<QueryBox> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
    std::iota(items_.begin(), items_.end(), 0u);
    if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
  }

  /// Calls `visit(i)` for every box that `enter(box)` accepts with all boxes above it. Boxes on the side of
  /// the point come first.
  template <class Enter, class Visit>
  void visit(const Vec3d& point, const Enter& enter, const Visit& visit) const {
    if (!nodes_.empty()) visit_node(0, point, enter, visit);
  }

 private:
  struct Node {
    QueryBox box;
    std::uint32_t begin = 0, end = 0;  // in items_
    std::uint32_t right = 0;           // 0 for a leaf; the left child is the next node
    int axis = 0;
  };

  void build(std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint32_t most_in_leaf = 4;
    Node node{boxes_[items_[begin]], begin, end};
    for (std::uint32_t i = begin + 1; i < end; ++i) node.box = united(node.box, boxes_[items_[i]]);
    node.axis = main_axis(node.box.max - node.box.min);
    const std::size_t index = nodes_.size();
    nodes_.push_back(node);
    if (end - begin <= most_in_leaf) return;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [&](std::uint32_t p, std::uint32_t q) {
                       return std::pair(boxes_[p].min[node.axis], p) < std::pair(boxes_[q].min[node.axis], q);
                     });
    build(begin, middle);
    nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
  }

  template <class Enter, class Visit>
  void visit_node(std::uint32_t index, const Vec3d& point, const Enter& enter, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (!enter(node.box)) return;
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        if (enter(boxes_[items_[i]])) visit(items_[i]);
      }
      return;
    }
    const bool is_right_first = point[node.axis] > nodes_[node.right].box.min[node.axis];
    visit_node(is_right_first ? node.right : index + 1, point, enter, visit);
    visit_node(is_right_first ? index + 1 : node.right, point, enter, visit);
  }

  std::vector<QueryBox> boxes_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace supple
