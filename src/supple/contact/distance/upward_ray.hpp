#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "contact/distance/element_distance.hpp"
#include "geometry/exact_predicates.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple {

/// A ray straight up from a point. Counts the triangles that it crosses, exactly: it stands for the ray from
/// beside the point, moved by (e, e²) for an infinitely small e > 0, which meets no edge.
class UpwardRay {
 public:
  explicit UpwardRay(const Vec3d& start) : start_(start) {}

  /// Counts a triangle, once.
  void meet(const TrianglePoints& corners) {
    if (starts_on_surface_) return;
    const auto [x, y, z] = std::array{bounds(corners, 0), bounds(corners, 1), bounds(corners, 2)};
    if (x.first > start_.x || start_.x > x.second || y.first > start_.y || start_.y > y.second) return;
    if (z.second < start_.z) return;
    if (z.first <= start_.z && has_start(corners)) {
      starts_on_surface_ = true;
      return;
    }
    const int turn = turn_around(corners);
    if (turn != 0 && orient3d(corners[0], corners[1], corners[2], start_, used_exact_) * turn < 0)
      is_odd_ = !is_odd_;
  }

  /// The point is in one of the triangles.
  bool starts_on_surface() const { return starts_on_surface_; }
  bool is_odd() const { return is_odd_; }

 private:
  static std::pair<double, double> bounds(const TrianglePoints& corners, int axis) {
    return std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
  }
  bool has_start(const TrianglePoints& corners) {
    return orient3d(corners[0], corners[1], corners[2], start_, used_exact_) == 0 &&
           distance_within({{start_, corners[0], corners[1], corners[2]}, 1, 3}, 0, used_exact_).has_value();
  }
  /// The turn of a, b and the moved point in the x-y plane. 0 only when a and b have equal x and y.
  int turn_beside(const Vec3d& a, const Vec3d& b) {
    if (const int turn = orient2d(a, b, start_, 2, used_exact_)) return turn;
    if (a.y != b.y) return a.y > b.y ? 1 : -1;
    return (b.x > a.x) - (b.x < a.x);
  }
  /// The turn of the corners if the line through the moved point crosses the triangle, otherwise 0.
  int turn_around(const TrianglePoints& corners) {
    const int turn = turn_beside(corners[0], corners[1]);
    if (turn == 0 || turn_beside(corners[1], corners[2]) != turn) return 0;
    return turn_beside(corners[2], corners[0]) == turn ? turn : 0;
  }

  Vec3d start_;
  bool starts_on_surface_ = false, is_odd_ = false, used_exact_ = false;
};

}  // namespace supple
