#pragma once

#include <array>

#include "supple/types.hpp"

namespace supple::benchmarks {

/// The weights of b and c in the point of the triangle (a, b, c) that is nearest to p (Ericson, Real-Time
/// Collision Detection, 5.1.5). The numbers are the products of b - a and c - a with p - a, p - b and p - c.
template <class Scalar>
std::array<Scalar, 2> nearest_weights(Scalar d1, Scalar d2, Scalar d3, Scalar d4, Scalar d5, Scalar d6) {
  const Scalar va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const Scalar w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - w, w};
  }
  const Scalar part = 1 / (va + vb + vc);
  return {vb * part, vc * part};
}

/// Distances in plain double precision, as a user of another library would compute them (Ericson, Real-Time
/// Collision Detection, 5.1.5 and 5.1.9).
double plain_distance(const Vec3d& point, const std::array<Vec3d, 3>& triangle);
double plain_distance(const std::array<Vec3d, 2>& a, const std::array<Vec3d, 2>& b);

}  // namespace supple::benchmarks
