#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/vector.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple {

// Error bounds of the floating-point filters. e = 2^-53 is the rounding error of one operation.
//
// The volume n·w of differences u, v, w with n = u × v is a sum of six products of three differences. Each
// product goes through 8 roundings (3 differences, product, difference of products, product, 2 sums). So the
// error of the computed value is at most ((1 + e)^8 - 1) times the sum of the products' magnitudes. That sum
// is computed as m·|w| with m_x = |u_y v_z| + |u_z v_y| and so on, which is too small by a factor of at most
// (1 - e)^8. The total error is less than 9 e; 10 e also covers the rounding of the bound.
//
// Underflow: sums and differences that underflow are exact. A product that underflows adds an error of at
// most 2^-1075. Two such errors in n_x are multiplied by |w_x|, and a third is added to the result. The total
// is at most 2^-1074 (|w_x| + |w_y| + |w_z|) (1 + 8 e) + 3 · 2^-1075 (1 + 2 e). The bound uses 2^-1000 in
// place of both factors, which is much larger.
//
// Overflow: |n| <= m and |n·w| <= m·|w| hold for the rounded numbers and for each partial sum, because
// rounding is monotonic. So an overflow anywhere makes the bound infinite or NaN, and then no comparison
// "|value| > bound" is true. The same holds for infinite coordinates.
inline constexpr double volume_error = 10 * 0x1p-53;
/// The bound of u_x v_y - u_y v_x, which has 4 roundings.
inline constexpr double area_error = 6 * 0x1p-53;
inline constexpr double underflow_error = 0x1p-1000;

/// A value and a bound of its error. When |value| > bound, the sign is correct.
struct Filtered {
  double value, bound;

  bool certain() const { return std::fabs(value) > bound; }
  int sign() const { return value > 0 ? 1 : -1; }
};

/// The component along `axis` of (b - a) × (c - a).
inline Filtered filtered_turn(const Vec3d& a, const Vec3d& b, const Vec3d& c, int axis) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double left = (b[x] - a[x]) * (c[y] - a[y]), right = (b[y] - a[y]) * (c[x] - a[x]);
  return {left - right, area_error * (std::fabs(left) + std::fabs(right)) + underflow_error};
}

/// The plane through three points, rounded, with the sums that bound the rounding errors.
struct FilteredPlane {
  Vec3d origin, normal, magnitude;

  explicit FilteredPlane(const TrianglePoints& triangle)
      : FilteredPlane(triangle[0], triangle[1], triangle[2]) {}
  FilteredPlane(const Vec3d& a, const Vec3d& b, const Vec3d& c) : origin(a) {
    const Vec3d u = b - a, v = c - a;
    const Vec3d first{u.y * v.z, u.z * v.x, u.x * v.y}, second{u.z * v.y, u.x * v.z, u.y * v.x};
    normal = first - second;
    magnitude = absolute(first) + absolute(second);
  }

  /// The error bound for points that differ from the origin by at most `reach` along each axis.
  double bound(const Vec3d& reach) const {
    return volume_error * dot(magnitude, reach) + underflow_error * (reach.x + reach.y + reach.z) +
           underflow_error;
  }
  /// Six times the volume of the tetrahedron of the three points and `point`.
  Filtered side(const Vec3d& point) const {
    const Vec3d w = point - origin;
    return {dot(normal, w), bound(absolute(w))};
  }
};

/// `FilteredPlane::side` of the three corners of a triangle, with one bound for all of them.
struct FilteredSides {
  std::array<double, 3> value;
  double bound;

  FilteredSides(const FilteredPlane& plane, const TrianglePoints& triangle) {
    const Vec3d w0 = triangle[0] - plane.origin, w1 = triangle[1] - plane.origin,
                w2 = triangle[2] - plane.origin;
    value = {dot(plane.normal, w0), dot(plane.normal, w1), dot(plane.normal, w2)};
    bound = plane.bound(larger(larger(absolute(w0), absolute(w1)), absolute(w2)));
  }

  Filtered operator[](std::size_t i) const { return {value[i], bound}; }
  /// True when all three corners are certainly on one side of the plane.
  bool separated() const {
    return std::max(std::min(std::min(value[0], value[1]), value[2]),
                    -std::max(std::max(value[0], value[1]), value[2])) > bound;
  }
};

}  // namespace supple
