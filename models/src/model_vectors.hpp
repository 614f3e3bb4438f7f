#pragma once

#include "geometry/vector.hpp"
#include "supple/types.hpp"

namespace supple::models {

/// `a` must not be zero.
inline Vec3d unit(Vec3d a) {
  return a * (1 / norm(a));
}

inline Vec3d lerp(Vec3d a, Vec3d b, double t) {
  return a + (b - a) * t;
}

/// Reflects at the plane z = 0, the symmetry plane of every model that has a left and a right side.
inline Vec3d mirrored(Vec3d a) {
  return {a.x, a.y, -a.z};
}

}  // namespace supple::models
