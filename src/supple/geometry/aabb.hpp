#pragma once

#include <algorithm>

#include "core/float_rounding.hpp"
#include "supple/types.hpp"

namespace supple {

/// Closed boxes: touching counts. The test is exact, floats compare exactly.
inline bool overlap(const Aabb& a, const Aabb& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

inline void extend(Aabb& box, const Aabb& other) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], other.min[axis]);
    box.max[axis] = std::max(box.max[axis], other.max[axis]);
  }
}

/// The smallest box of floats that holds the (finite) point.
template <class Scalar>
void extend(Aabb& box, const Vec3<Scalar>& point) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], round_down(point[axis]));
    box.max[axis] = std::max(box.max[axis], round_up(point[axis]));
  }
}

}  // namespace supple
