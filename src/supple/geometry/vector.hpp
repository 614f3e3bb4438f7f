#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

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

/// The vector divided by its largest coordinate, so that squares neither overflow nor underflow, or 0 when it
/// has no direction.
inline Vec3d scaled(const Vec3d& v) {
  const double size = largest_magnitude(v);
  return size > 0 && std::isfinite(size) ? v / size : Vec3d{};
}
/// A vector of length 1, or 0 when `v` has no direction.
inline Vec3d normalized(const Vec3d& v) {
  const Vec3d s = scaled(v);
  return s == Vec3d{} ? s : (1 / norm(s)) * s;
}
/// The first of the axes along which the vector is shortest.
inline Vec3d shortest_axis(const Vec3d& v) {
  const Vec3d size = absolute(v);
  if (size.x <= size.y && size.x <= size.z) return {1, 0, 0};
  return size.y <= size.z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
}

/// A number that was multiplied by a scale, at most the largest double.
inline double restored(double scaled, double scale) {
  constexpr double most = std::numeric_limits<double>::max();
  return std::clamp(scaled / scale, -most, most);
}
inline Vec3d restored(const Vec3d& scaled, double scale) {
  return {restored(scaled.x, scale), restored(scaled.y, scale), restored(scaled.z, scale)};
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
