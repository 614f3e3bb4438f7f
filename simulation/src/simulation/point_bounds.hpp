#pragma once

#include <algorithm>
#include <limits>

#include "supple/types.hpp"

namespace supple {

/// The lowest and the highest coordinates of points. A coordinate that is NaN changes nothing.
struct PointBounds {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3d low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};

  void add(const Vec3d& point) { add({point, point}); }
  void add(const PointBounds& other) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], other.low[axis]);
      high[axis] = std::max(high[axis], other.high[axis]);
    }
  }
};

}  // namespace supple
