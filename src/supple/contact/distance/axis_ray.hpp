#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "contact/distance/element_distance.hpp"
#include "geometry/exact_predicates.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple {

/// A ray from a point along an axis, or against it with the direction -1. Counts the triangles that it
/// crosses, exactly: it stands for the ray from beside the point, moved along the next two axes by (e, e²)
/// for an infinitely small e > 0, which meets no edge.
class AxisRay {
 public:
  explicit AxisRay(const Vec3d& start, int axis = 2, int direction = 1)
      : start_(start), axis_(axis), direction_(direction) {}

  /// Counts a triangle, once.
  void meet(const TrianglePoints& corners) {
    if (starts_on_surface_) return;
    const auto [x, y, z] = std::array{bounds(corners, x_), bounds(corners, y_), bounds(corners, axis_)};
    if (x.first > start_[x_] || start_[x_] > x.second || y.first > start_[y_] || start_[y_] > y.second)
      return;
    const bool is_behind = direction_ > 0 ? z.second < start_[axis_] : z.first > start_[axis_];
    const bool is_ahead = direction_ > 0 ? z.first > start_[axis_] : z.second < start_[axis_];
    if (is_behind) return;
    bool has_left = false, has_right = false;  // most triangles are certainly beside the ray
    for (std::size_t i = 0; i < 3; ++i) {
      const Filtered turn = filtered_turn(start_, corners[i], corners[(i + 1) % 3], axis_);
      has_left = has_left || turn.value > turn.bound;
      has_right = has_right || turn.value < -turn.bound;
    }
    if (has_left && has_right) return;
    const int turn = direction_ * turn_around(corners);
    const int side = is_ahead ? -turn : orient3d(corners[0], corners[1], corners[2], start_, used_exact_);
    if (side * turn < 0) is_odd_ = !is_odd_;
    starts_on_surface_ = side == 0 && !is_ahead && has_start(corners);
  }

  /// The point is in one of the triangles.
  bool starts_on_surface() const { return starts_on_surface_; }
  bool is_odd() const { return is_odd_; }

 private:
  static std::pair<double, double> bounds(const TrianglePoints& corners, int axis) {
    const double a = corners[0][axis], b = corners[1][axis], c = corners[2][axis];
    return {std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
  }
  bool has_start(const TrianglePoints& corners) {
    return distance_within({{start_, corners[0], corners[1], corners[2]}, 1, 3}, 0, used_exact_).has_value();
  }
  /// The turn of a, b and the moved point as seen along the axis. 0 only when a and b are at one place there.
  int turn_beside(const Vec3d& a, const Vec3d& b) {
    if (const int turn = orient2d(a, b, start_, axis_, used_exact_)) return turn;
    if (a[y_] != b[y_]) return a[y_] > b[y_] ? 1 : -1;
    return (b[x_] > a[x_]) - (b[x_] < a[x_]);
  }
  /// The turn of the corners if the line through the moved point crosses the triangle, otherwise 0.
  int turn_around(const TrianglePoints& corners) {
    const int turn = turn_beside(corners[0], corners[1]);
    if (turn == 0 || turn_beside(corners[1], corners[2]) != turn) return 0;
    return turn_beside(corners[2], corners[0]) == turn ? turn : 0;
  }

  Vec3d start_;
  int axis_, direction_, x_ = (axis_ + 1) % 3, y_ = (axis_ + 2) % 3;
  bool starts_on_surface_ = false, is_odd_ = false, used_exact_ = false;
};

}  // namespace supple
