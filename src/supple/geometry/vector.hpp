#pragma once

#include <algorithm>
#include <cmath>

#include "supple/types.hpp"

namespace supple {

// Sums from left to right, each operation rounded once: error bounds elsewhere rely on it.

inline double dot(const Vec3d& a, const Vec3d& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3d& v) {
  return std::sqrt(dot(v, v));
}

inline bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline Vec3d absolute(const Vec3d& v) {
  return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
}
inline Vec3d larger(const Vec3d& a, const Vec3d& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
/// The largest magnitude of a coordinate.
inline double largest_magnitude(const Vec3d& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

/// a at t = 0, b at t = 1, exactly.
inline double mix(double a, double b, double t) {
  return (1 - t) * a + t * b;
}
inline Vec3d mix(const Vec3d& a, const Vec3d& b, double t) {
  return (1 - t) * a + t * b;
}

}  // namespace supple
