#pragma once

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

}  // namespace supple
