#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple {

/// Triangles of two surfaces, a below b, and how far a has to move to pass b. Keeps its memory.
class CurveParts {
 public:
  void clear() {
    for (auto& part : triangles_) part.clear();
    is_built_ = {};
  }
  /// Coordinates are about 1 or less. `side` is 0 for a and 1 for b.
  void add(std::size_t side, std::uint32_t triangle, const TrianglePoints& corners) {
    triangles_[side].push_back({corners, triangle});
    is_built_[side] = false;
  }

  /// Rounding of coordinates can make ways this long.
  static constexpr double rounding = 0x1p-49;
  static constexpr double nothing_ahead = std::numeric_limits<double>::infinity();

  /// The longest way along the unit vector from a point of a to a point of b, at least 0: so a passes b by
  /// this move. Triangles that are parallel to the vector, or that overlap only by rounding as seen along it,
  /// have no such points. Where there are none at all, `nothing_ahead`. The result is never too short; up to
  /// `rounding`, it may be too long. Ways up to `least` do not count. The search ends where the way exceeds
  /// `limit`. O(n log n) for n triangles whose pairs have ways that differ by more than rounding, and O(n)
  /// for further directions.
  double way_along(const Vec3d& normal, double limit = nothing_ahead, double least = -nothing_ahead);
  /// A triangle of a and one of b.
  using Ends = std::array<std::uint32_t, 2>;
  /// After `way_along` without a limit: those between which the longest way is, if there is one.
  const Ends& ends() const { return ends_; }
  /// A point of triangle p in the middle of what it shares with q as seen along the unit vector; nothing
  /// where they share nothing.
  std::optional<Vec3d> middle_of(const TrianglePoints& p, const TrianglePoints& q, const Vec3d& normal);

  /// After `way_along`: whether a triangle of the other side is straight ahead of a point of a, or straight
  /// behind a point of b, within the way. Points on borders count.
  bool is_covered(std::size_t side, const Vec3d& point, double way);

 private:
  /// By the coordinates across the vector, and its height along it in z.
  struct Box {
    Vec3d min, max;
    bool is_upright = false;  // all triangles are parallel to the vector: such have no way between them
    void include(const Box& other) {
      for (int axis = 0; axis < 3; ++axis) {
        min[axis] = other.min[axis] < min[axis] ? other.min[axis] : min[axis];
        max[axis] = other.max[axis] > max[axis] ? other.max[axis] : max[axis];
      }
      is_upright = is_upright && other.is_upright;
    }
  };
  struct Part {
    TrianglePoints corners;
    std::uint32_t triangle = 0;
  };
  struct Projected {
    TrianglePoints corners;
    Box box;
  };
  struct Node {
    Box box;
    std::uint32_t first = 0, last = 0;  // triangles
    std::uint32_t child = 0;            // the first of two; 0 for a leaf
  };
  struct Pair {
    std::uint32_t a, b;
    double bound;
  };

  void look_along(const Vec3d& normal);
  void build(std::size_t side);
  void split(std::size_t side, std::uint32_t node);
  void project(std::size_t side);
  Vec3d seen(const Vec3d& p) const { return {dot(axes_[0], p), dot(axes_[1], p), dot(axes_[2], p)}; }
  TrianglePoints seen(const TrianglePoints& p) const { return {seen(p[0]), seen(p[1]), seen(p[2])}; }

  std::array<std::vector<Part>, 2> triangles_;
  std::array<std::vector<Projected>, 2> projected_;
  std::array<std::vector<Node>, 2> nodes_;
  std::vector<Pair> stack_;
  std::array<bool, 2> is_built_{};
  Ends ends_{};
  std::array<Vec3d, 3> axes_;  // the last one is the vector
};

}  // namespace supple
