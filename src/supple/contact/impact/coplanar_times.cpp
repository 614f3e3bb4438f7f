#include "contact/impact/coplanar_times.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Whether all values are on one side of 0 by more than `error`.
bool one_sign(const std::array<double, 4>& c, double error) {
  const double least = std::min(std::min(c[0], c[1]), std::min(c[2], c[3]));
  const double most = std::max(std::max(c[0], c[1]), std::max(c[2], c[3]));
  return std::max(least, -most) > error;
}

/// Bernstein coefficients of the parts before and after `t`.
std::pair<std::array<double, 4>, std::array<double, 4>> split(const std::array<double, 4>& c, double t) {
  const double c01 = mix(c[0], c[1], t), c12 = mix(c[1], c[2], t), c23 = mix(c[2], c[3], t);
  const double c012 = mix(c01, c12, t), c123 = mix(c12, c23, t), middle = mix(c012, c123, t);
  return {{c[0], c01, c012, middle}, {middle, c123, c23, c[3]}};
}

bool part_has_one_sign(const std::array<double, 4>& c, double error, int halvings) {
  if (one_sign(c, error)) return true;
  if (halvings == 0 || std::max(c[0], -c[0]) <= error || std::max(c[3], -c[3]) <= error) return false;
  const auto [before, after] = split(c, 0.5);
  return part_has_one_sign(before, error, halvings - 1) && part_has_one_sign(after, error, halvings - 1);
}

}  // namespace

// Error bound, relative to the sum of the magnitudes, which bounds every coefficient:
// - a determinant of differences: 9 · 2^-53 (see plane_filter.hpp);
// - the sum of three determinants, divided by 3: 12 · 2^-53;
// - a value, or the coefficients of a part: two times three levels of 3 roundings, 18 · 2^-53 more.
// That is less than 2^-48 in all. Each of three halvings adds 9 · 2^-53, so 2^-47 covers everything.
//
// Coordinates up to 2^100 do not overflow and lose at most 2^-970 by underflow.
VolumePolynomial::VolumePolynomial(const RelativeMotion& motion) {
  const auto& [start, end, is_square] = motion;
  const Vec3d n0 = cross(start.u, start.w), n2 = cross(end.u, end.w);
  const Vec3d twice_n1 = cross(start.u, end.w) + cross(end.u, start.w);
  coefficients_ = {dot(start.m, n0), (dot(end.m, n0) + dot(start.m, twice_n1)) / 3,
                   (dot(start.m, n2) + dot(end.m, twice_n1)) / 3, dot(end.m, n2)};
  const auto& c = coefficients_;
  powers_ = {c[0], 3 * (c[1] - c[0]), 3 * (c[2] - 2 * c[1] + c[0]), c[3] - 3 * (c[2] - c[1]) - c[0]};
  const Vec3d m = larger(absolute(start.m), absolute(end.m));
  const Vec3d u = larger(absolute(start.u), absolute(end.u));
  const Vec3d w = larger(absolute(start.w), absolute(end.w));
  const Vec3d minors{u.y * w.z + u.z * w.y, u.z * w.x + u.x * w.z, u.x * w.y + u.y * w.x};
  in_range_ = largest_magnitude(larger(larger(m, u), w)) <= 0x1p100;
  error_ = 0x1p-47 * dot(m, minors) + 0x1p-960;
  always_zero_ = true;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    always_zero_ = always_zero_ && (m[i] == 0 || ((u[j] == 0 || w[k] == 0) && (u[k] == 0 || w[j] == 0)));
  }
}

bool VolumePolynomial::never_or_always_zero_after_start() const {
  const auto& [c0, c1, c2, c3] = coefficients_;
  return in_range_ && (always_zero_ || one_sign({c1, c1, c2, c3}, error_));
}

double VolumePolynomial::value(double t) const {
  const auto& c = coefficients_;
  const double c01 = mix(c[0], c[1], t), c12 = mix(c[1], c[2], t), c23 = mix(c[2], c[3], t);
  return mix(mix(c01, c12, t), mix(c12, c23, t), t);
}

bool VolumePolynomial::never_zero(double low, double high) const {
  constexpr int halvings = 3;
  if (low >= high) return true;
  std::array<double, 4> part = coefficients_;
  if (high < 1) part = split(part, high).first;
  if (low > 0) part = split(part, low / high).second;
  return part_has_one_sign(part, error_, halvings);
}

bool VolumePolynomial::changes_sign(double low, double high) const {
  const double first = value(low), last = value(high);
  return std::min(std::fabs(first), std::fabs(last)) > error_ && (first > 0) != (last > 0);
}

void VolumePolynomial::add_turning_points(std::array<double, 4>& knots, std::size_t& count) const {
  const double a = 3 * powers_[3], b = powers_[2], d = powers_[1];  // the slope is a t^2 + 2 b t + d
  const double discriminant = b * b - a * d;
  if (!(discriminant > 0)) return;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  double first = q / a, second = d / q;
  if (second < first) std::swap(first, second);
  for (const double t : {first, second}) {
    if (t > 0 && t < 1) knots[count++] = t;
  }
}

double VolumePolynomial::zero_between(double low, double high, double at_low, double at_high) const {
  double t = low + (high - low) * (at_low / (at_low - at_high));
  for (int step = 0; step < 60; ++step) {
    if (!(t > low && t < high)) t = low + (high - low) / 2;
    const double at = estimate(t);
    if (std::fabs(at) <= error_ / 4) break;
    ((at > 0) == (at_low > 0) ? low : high) = t;
    t -= at / slope(t);
  }
  return t;
}

VolumePolynomial::Intervals VolumePolynomial::near_zeros() const {
  Intervals result;
  const auto add = [&](double t, double reach) {
    // Only short intervals are useful. NaN gives the whole step.
    const double half = reach < 1 ? reach + 0x1p-52 : 1;
    const Interval interval{std::max(t - half, 0.0), std::min(t + half, 1.0)};
    if (result.count != 0 && result.items[result.count - 1].high >= interval.low) {
      Interval& last = result.items[result.count - 1];
      last = {std::min(last.low, interval.low), std::max(last.high, interval.high)};
    } else {
      result.items[result.count++] = interval;
    }
  };
  std::array<double, 4> knots{0};
  std::size_t count = 1;
  add_turning_points(knots, count);
  knots[count++] = 1;
  double here = estimate(0);
  for (std::size_t k = 0;; ++k) {
    if (std::fabs(here) <= 2 * error_) {
      const double t = knots[k], curvature = 3 * powers_[3] * t + powers_[2];
      const bool turning = k != 0 && k + 1 != count;
      add(t, turning ? 4 * std::sqrt(error_ / std::fabs(curvature)) : 4 * error_ / std::fabs(slope(t)));
    }
    if (k + 1 == count) break;
    const double next = estimate(knots[k + 1]);
    if ((here > 0) != (next > 0)) {
      const double t = zero_between(knots[k], knots[k + 1], here, next);
      add(t, 2 * error_ / std::fabs(slope(t)));
    }
    here = next;
  }
  return result;
}

}  // namespace supple
