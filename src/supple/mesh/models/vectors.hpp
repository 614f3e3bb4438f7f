#pragma once

#include <cmath>

#include "supple/types.hpp"

namespace supple::models {

inline double dot(Vec3d a, Vec3d b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double length(Vec3d a) {
  return std::sqrt(dot(a, a));
}

/// The direction of `a`, which must not be zero.
inline Vec3d unit(Vec3d a) {
  return a * (1 / length(a));
}

inline Vec3d lerp(Vec3d a, Vec3d b, double t) {
  return a + (b - a) * t;
}

/// Mirrored at the plane z = 0, which divides every model that has a left and a right.
inline Vec3d mirrored(Vec3d a) {
  return {a.x, a.y, -a.z};
}

}  // namespace supple::models
