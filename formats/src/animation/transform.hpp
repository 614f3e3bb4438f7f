#pragma once

#include <array>
#include <cstddef>

#include "supple/types.hpp"

namespace supple {

/// The upper three rows of a matrix that maps points, as columns.
using Transform = std::array<std::array<double, 4>, 3>;
inline constexpr Transform identity_transform = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/// A quaternion x, y, z, w.
using Quaternion = std::array<double, 4>;

inline Transform operator*(const Transform& a, const Transform& b) {
  Transform product;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      product[row][column] = a[row][0] * b[0][column] + a[row][1] * b[1][column] + a[row][2] * b[2][column];
    }
    product[row][3] += a[row][3];
  }
  return product;
}

/// Multiplying by an identity would change infinities and the sign of zero, so it returns the point.
inline Vec3d apply(const Transform& m, const Vec3d& p) {
  if (m == identity_transform) return p;
  const auto coordinate = [&](std::size_t row) {
    return m[row][0] * p.x + m[row][1] * p.y + m[row][2] * p.z + m[row][3];
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

inline bool mirrors(const Transform& m) {
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return determinant < 0;
}

/// Translation · rotation · scale. The quaternion need not have length 1.
inline Transform compose(const Vec3d& translation, const Quaternion& q, const Vec3d& scale) {
  const double squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const double s = squared > 0 ? 2 / squared : 0;
  const double xx = s * q[0] * q[0], yy = s * q[1] * q[1], zz = s * q[2] * q[2];
  const double xy = s * q[0] * q[1], xz = s * q[0] * q[2], yz = s * q[1] * q[2];
  const double xw = s * q[0] * q[3], yw = s * q[1] * q[3], zw = s * q[2] * q[3];
  return {{{(1 - (yy + zz)) * scale.x, (xy - zw) * scale.y, (xz + yw) * scale.z, translation.x},
           {(xy + zw) * scale.x, (1 - (xx + zz)) * scale.y, (yz - xw) * scale.z, translation.y},
           {(xz - yw) * scale.x, (yz + xw) * scale.y, (1 - (xx + yy)) * scale.z, translation.z}}};
}

}  // namespace supple
