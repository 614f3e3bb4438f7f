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
// takes part in 8 roundings (3 differences, product, difference of products, product, 2 sums), so the
// computed value is off by at most ((1 + e)^8 - 1) times the sum of the products' magnitudes. That sum,
// computed as m·|w| with m_x = |u_y v_z| + |u_z v_y| and so on, is itself too small by a factor of at most (1
// - e)^8. Together less than 9 e; 10 e also covers the rounding of the bound.
//
// Underflow: sums and differences underflow exactly, a product is off by at most 2^-1075 more. Two of those
// in n_x are multiplied by |w_x|, one more stands alone: at most 2^-1074 (|w_x| + |w_y| + |w_z|) (1 + 8 e)
// + 3 · 2^-1075 (1 + 2 e) in all, and 2^-1000 in place of both factors is far above that.
//
// Overflow: |n| <= m and |n·w| <= m·|w| hold for the rounded numbers, partial sum by partial sum, because
// rounding is monotone. So an overflow anywhere makes the bound infinite or NaN, and no comparison
// "|value| > bound" is then true. The same goes for coordinates that are infinite.
inline constexpr double volume_error = 10 * 0x1p-53;
/// Likewise for u_x v_y - u_y v_x: 4 roundings.
inline constexpr double area_error = 6 * 0x1p-53;
inline constexpr double underflow_error = 0x1p-1000;

/// A value and a bound of its error. When |value| > bound, the sign is exact.
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

/// The sides of the three corners of a triangle, with one bound for all of them.
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
  /// Whether all three are certainly on one side of the plane.
  bool separated() const {
    return std::max(std::min(std::min(value[0], value[1]), value[2]),
                    -std::max(std::max(value[0], value[1]), value[2])) > bound;
  }
};

}  // namespace supple
