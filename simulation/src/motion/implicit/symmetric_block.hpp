#pragma once

#include <cmath>

#include "geometry/vector.hpp"

namespace supple {

/// A symmetric 3 × 3 matrix.
struct SymmetricBlock {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  /// n nᵀ · factor
  static SymmetricBlock outer(Vec3d n, double factor) {
    const Vec3d f = n * factor;
    return {f.x * n.x, f.x * n.y, f.x * n.z, f.y * n.y, f.y * n.z, f.z * n.z};
  }

  void add_diagonal(double value) {
    xx += value;
    yy += value;
    zz += value;
  }
  SymmetricBlock& operator+=(const SymmetricBlock& b) {
    xx += b.xx;
    xy += b.xy;
    xz += b.xz;
    yy += b.yy;
    yz += b.yz;
    zz += b.zz;
    return *this;
  }
  SymmetricBlock negative() const { return {-xx, -xy, -xz, -yy, -yz, -zz}; }
  Vec3d operator*(Vec3d v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }

  /// The inverse by Cholesky factors of a matrix whose eigenvalues are at least `smallest` > 0. The result
  /// is positive definite in spite of rounding.
  SymmetricBlock inverse(double smallest) const {
    const double a = std::sqrt(std::fmax(xx, smallest));
    const double b = xy / a, c = xz / a;
    const double d = std::sqrt(std::fmax(yy - b * b, smallest));
    const double e = (yz - c * b) / d;
    const double f = std::sqrt(std::fmax(zz - c * c - e * e, smallest));
    // Rows of the inverse of the lower triangular factor.
    const double ia = 1 / a, id = 1 / d, lf = 1 / f;
    const double ba = -b * ia * id, ea = -(c * ia + e * ba) * lf, ed = -e * id * lf;
    return {ia * ia + ba * ba + ea * ea, ba * id + ea * ed, ea * lf, id * id + ed * ed, ed * lf, lf * lf};
  }
};

}  // namespace supple
