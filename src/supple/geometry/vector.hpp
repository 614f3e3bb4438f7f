#pragma once

#include <algorithm>
#include <cmath>

#include "supple/types.hpp"

namespace supple {

inline bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline Vec3d in_double(const Vec3f& v) {
  return {v.x, v.y, v.z};
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

/// As `norm`, also when the square of the vector overflows or underflows. `std::hypot` of three numbers gives
/// other bits in each standard library.
inline double scaled_norm(const Vec3d& v) {
  const double largest = largest_magnitude(v);
  return largest > 0 && std::isfinite(largest) ? largest * norm(v / largest) : largest;
}

/// v · 2^exponent.
inline Vec3d scaled(const Vec3d& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

/// Exactly a at t = 0, and exactly b at t = 1.
inline double mix(double a, double b, double t) {
  return (1 - t) * a + t * b;
}
inline Vec3d mix(const Vec3d& a, const Vec3d& b, double t) {
  return (1 - t) * a + t * b;
}

}  // namespace supple
