#pragma once

#include <cmath>

#include "core/float_rounding.hpp"
#include "supple/types.hpp"

namespace supple {

/// Whether two closed spheres overlap after b is moved by `offset` and its radius grows by `slop`. Compares
/// in double, so that differences and squares of floats do not overflow. Conservative: it may report an
/// overlap when rounding cannot separate the spheres, but it never misses one. Symmetric.
inline bool overlap(const BoundingSphere& a, const BoundingSphere& b, const Vec3f& offset = {},
                    float slop = 0) {
  if (a.empty() || b.empty()) return false;
  const double dx = double{b.center.x} + offset.x - a.center.x;
  const double dy = double{b.center.y} + offset.y - a.center.y;
  const double dz = double{b.center.z} + offset.z - a.center.z;
  const double reach = double{a.radius} + b.radius + slop;
  // The factor covers six roundings of 2^-53. The comparison makes NaN overlap.
  return !(dx * dx + dy * dy + dz * dz > reach * reach * (1 + 0x1p-49));
}

/// Encloses fl(p + offset) for every p in the sphere.
inline BoundingSphere moved(const BoundingSphere& sphere, const Vec3d& offset) {
  if (offset == Vec3d{} || sphere.empty()) return sphere;
  BoundingSphere result;
  double squared_shift = 0;  // of the centre by rounding it to float
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
