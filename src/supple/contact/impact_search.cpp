#include "contact/impact_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "contact/closest_points.hpp"
#include "contact/coplanar_times.hpp"
#include "geometry/plane_filter.hpp"

namespace supple {
namespace {

using Outcome = ImpactSearch::Outcome;

Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double largest(const Vec3d& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}
Vec3d mix(const Vec3d& a, const Vec3d& b, double t) {
  return (1 - t) * a + t * b;
}

/// Greatest magnitudes over the step of a vector that goes straight, and of its change.
struct Extent {
  double size, change;

  Extent(const Vec3d& start, const Vec3d& end)
      : size(std::max(largest(start), largest(end))), change(largest(end - start)) {}
};

enum class Place : std::uint8_t { inside, outside, unclear };

/// Where the common point of the elements lies, were there one at any time within [low, high].
///
/// From m = alpha u + beta w follow (m × w) · n = alpha n² and (u × m) · n = beta n² with n = u × w, also
/// where n is zero. Each of these and n² is a sum of twelve products of four coordinates. At the middle they
/// are off by at most 20 roundings: three for each factor and eight for the rest; and change towards the ends
/// by at most half the interval times twelve times the product with one factor replaced by its change.
Place place_in_domain(const RelativeMotion& motion, double low, double high) {
  const Extent em(motion.start.m, motion.end.m), eu(motion.start.u, motion.end.u),
      ew(motion.start.w, motion.end.w);
  const double drift = 12 * ((high - low) / 2 + 0x1p-53);
  constexpr double rounding = 0x1p-44;  // above 12 · 20 · 2^-53
  constexpr double underflow = 0x1p-700;
  const double uw = eu.size * ew.size;
  const double uw_change = eu.change * ew.size + eu.size * ew.change;
  const double mw_change = em.change * ew.size + em.size * ew.change;
  const double um_change = eu.change * em.size + eu.size * em.change;
  const double alpha_error = rounding * uw * em.size * ew.size +
                             drift * (uw_change * em.size * ew.size + uw * mw_change) + underflow;
  const double beta_error = rounding * uw * em.size * eu.size +
                            drift * (uw_change * em.size * eu.size + uw * um_change) + underflow;
  const double n_error = rounding * uw * uw + drift * 2 * uw * uw_change + underflow;

  const auto [m, u, w] = places_at(motion, low + (high - low) / 2);
  const Vec3d n = cross(u, w);
  const double alpha = dot(cross(m, w), n), beta = dot(cross(u, m), n), one = dot(n, n);
  // Distances from the borders of the domain, and what they may be off by.
  const std::array<Filtered, 4> square{{{alpha, alpha_error},
                                        {beta, beta_error},
                                        {one - alpha, alpha_error + n_error},
                                        {one - beta, beta_error + n_error}}};
  const std::array<Filtered, 3> triangle{{{alpha, alpha_error},
                                          {beta, beta_error},
                                          {one - alpha - beta, 2 * (alpha_error + beta_error + n_error)}}};
  const std::span<const Filtered> borders =
      motion.is_square ? std::span<const Filtered>(square) : std::span<const Filtered>(triangle);
  bool inside = one > n_error;
  for (const Filtered& border : borders) {
    if (border.value < -border.bound) return Place::outside;
    inside = inside && border.value > border.bound;
  }
  return inside ? Place::inside : Place::unclear;
}

/// By the times at which the four vertices lie in one plane.
Outcome search_coplanar_times(const RelativeMotion& motion, double& time) {
  constexpr double longest = impact_time_tolerance / 2;
  const VolumePolynomial volume(motion);
  if (!volume.in_range()) return Outcome::unsure;
  if (volume.never_zero(0, 1)) return Outcome::apart;
  double passed = 0;
  const VolumePolynomial::Intervals intervals = volume.near_zeros();
  for (const auto& [low, high] : intervals.all()) {
    if (!volume.never_zero(passed, low)) return Outcome::unsure;
    const Place place = place_in_domain(motion, low, high);
    if (place == Place::unclear) return Outcome::unsure;
    if (place == Place::inside) {
      time = low;
      return high - low <= longest && volume.changes_sign(low, high) ? Outcome::touching : Outcome::unsure;
    }
    passed = high;
  }
  return volume.never_zero(passed, 1) ? Outcome::apart : Outcome::unsure;
}

/// The least component along a direction that differences of the elements have, over the step.
///
/// Components of the differences' corners go straight in time. Each is off by at most 8 roundings of the
/// magnitudes' sum at the ends, and 3 more between them; the bound has twice that.
class DirectedGap {
 public:
  DirectedGap(const RelativeMotion& motion, const Vec3d& direction, double separation)
      : count_(motion.is_square ? 4 : 3) {
    corners(motion.start, direction, at_start_);
    corners(motion.end, direction, at_end_);
    const auto reach = [&](const Vec3d& a, const Vec3d& b) {
      return dot(absolute(direction), larger(absolute(a), absolute(b)));
    };
    slack_ = 0x1p-48 * (reach(motion.start.m, motion.end.m) + reach(motion.start.u, motion.end.u) +
                        reach(motion.start.w, motion.end.w)) +
             0x1p-900;
    // The addend is more than squares that underflow make.
    const double length = separation > 0 ? std::sqrt(dot(direction, direction) + 0x1p-900) : 0;
    least_ = separation * length * (1 + 0x1p-49) + slack_;
  }

  bool separates(double t) const {
    for (std::size_t i = 0; i < count_; ++i) {
      if (!((1 - t) * at_start_[i] + t * at_end_[i] > least_)) return false;
    }
    return true;
  }
  /// The time after `t` up to which the gap stays open; above 1 when it never closes, `t` when that cannot
  /// be told.
  double open_until(double t) const {
    if (separates(1)) return 2;
    double result = 1;
    for (std::size_t i = 0; i < count_; ++i) {
      if (at_end_[i] > least_) continue;
      result = std::min(result, (at_start_[i] - least_ - slack_) / (at_start_[i] - at_end_[i]));
    }
    return result > t && separates(result) ? result : t;
  }

 private:
  void corners(const RelativePlaces<double>& places, const Vec3d& direction, std::array<double, 4>& values) {
    const double m = dot(direction, places.m), u = dot(direction, places.u), w = dot(direction, places.w);
    values = {m, m - u, m - w, m - u - w};
  }

  std::size_t count_;
  std::array<double, 4> at_start_, at_end_;
  double least_, slack_;
};

/// Within the separation at time `t`, without doubt.
bool surely_touching(const RelativeMotion& motion, double separation, double t) {
  const ClosestPoints closest = closest_points(places_at(motion, t), motion.is_square);
  const double reach = largest(motion.start.m) + largest(motion.end.m) + largest(motion.start.u) +
                       largest(motion.end.u) + largest(motion.start.w) + largest(motion.end.w);
  // Not more than 12 roundings of each of three coordinates of the difference, 8 of the length.
  const double error = 0x1p-46 * reach + 0x1p-500;
  return std::sqrt(closest.squared_distance) * (1 + 0x1p-49) + error < separation;
}

/// Goes forward in time as long as the elements are seen to be apart along the direction in which they are
/// closest, looks again, and so on: directional conservative advancement. Near a turning face it closes in
/// quadratically.
Outcome advance(const RelativeMotion& motion, double separation, double& time) {
  constexpr int most_steps = 40;
  constexpr double least_progress = impact_time_tolerance / 16;
  time = 0;
  for (int step = 0; step < most_steps; ++step) {
    const ClosestPoints closest = closest_points(places_at(motion, time), motion.is_square);
    const DirectedGap gap(motion, closest.difference, separation);
    if (!gap.separates(time)) {
      return surely_touching(motion, separation, time) ? Outcome::touching : Outcome::unsure;
    }
    const double next = gap.open_until(time);
    if (next > 1) return Outcome::apart;
    if (next - time < least_progress) {
      time = next;
      const bool touching =
          surely_touching(motion, separation, std::min(1.0, next + impact_time_tolerance / 2));
      return touching ? Outcome::touching : Outcome::unsure;
    }
    time = next;
  }
  return Outcome::unsure;
}

}  // namespace

RelativePlaces<double> places_at(const RelativeMotion& motion, double time) {
  return {mix(motion.start.m, motion.end.m, time), mix(motion.start.u, motion.end.u, time),
          mix(motion.start.w, motion.end.w, time)};
}

ImpactSearch search_impact(const RelativeMotion& motion, double separation) {
  ImpactSearch search;
  if (separation == 0) {
    search.outcome = search_coplanar_times(motion, search.time);
    if (search.outcome != Outcome::unsure) return search;
  }
  search.outcome = advance(motion, separation, search.time);
  return search;
}

}  // namespace supple
