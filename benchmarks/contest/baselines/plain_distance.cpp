#include "contest/baselines/plain_distance.hpp"

#include <algorithm>
#include <cmath>

namespace supple::benchmarks {

double plain_distance(const Vec3d& p, const std::array<Vec3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const auto [v, w] =
      nearest_weights(dot(ab, ap), dot(ac, ap), dot(ab, bp), dot(ac, bp), dot(ab, cp), dot(ac, cp));
  return norm(ap - v * ab - w * ac);
}

double plain_distance(const std::array<Vec3d, 2>& p, const std::array<Vec3d, 2>& q) {
  const Vec3d d1 = p[1] - p[0], d2 = q[1] - q[0], r = p[0] - q[0];
  const double a = dot(d1, d1), e = dot(d2, d2), b = dot(d1, d2), c = dot(d1, r), f = dot(d2, r);
  const double denominator = a * e - b * b;
  double s = denominator > 0 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0;
  double t = (b * s + f) / e;
  if (t < 0) {
    t = 0;
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (t > 1) {
    t = 1;
    s = std::clamp((b - c) / a, 0.0, 1.0);
  }
  return norm(r + s * d1 - t * d2);
}

}  // namespace supple::benchmarks
