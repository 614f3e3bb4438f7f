#pragma once

#include <cmath>

#include "core/float_rounding.hpp"
#include "supple/types.hpp"

namespace supple {

/// Closed balls, compared in double so that neither differences nor squares of floats overflow. May report
/// balls as touching that are apart by rounding, never the reverse; symmetric in its arguments.
inline bool overlap(const BoundingSphere& a, const BoundingSphere& b) {
  if (a.empty() || b.empty()) return false;
  const double dx = double{a.center.x} - b.center.x;
  const double dy = double{a.center.y} - b.center.y;
  const double dz = double{a.center.z} - b.center.z;
  const double reach = double{a.radius} + b.radius;
  // Six roundings of 2^-53 relative error are well inside the factor. Written so that NaN overlaps.
  return !(dx * dx + dy * dy + dz * dz > reach * reach * (1 + 0x1p-49));
}

/// Encloses fl(p + offset) of every p in the ball.
inline BoundingSphere moved(const BoundingSphere& sphere, const Vec3d& offset) {
  if (offset == Vec3d{} || sphere.empty()) return sphere;
  BoundingSphere result;
  double squared_shift = 0;  // of the centre, by rounding it to float
  double magnitude = sphere.radius;
  for (int axis = 0; axis < 3; ++axis) {
    const double center = double{sphere.center[axis]} + offset[axis];
    result.center[axis] = static_cast<float>(center);
    const double shift = result.center[axis] - center;
    squared_shift += shift * shift;
    magnitude += std::abs(center);
  }
  result.radius =
      round_up(double{sphere.radius} + std::sqrt(squared_shift) * (1 + 0x1p-50) + magnitude * 0x1p-50);
  return result;
}

}  // namespace supple
