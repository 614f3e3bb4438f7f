#include "contact/impact/impact_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/distance/closest_points.hpp"
#include "contact/intersection/coplanar_search.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

using Outcome = ImpactSearch::Outcome;

/// The elements at one time: their differences, and where they are closest.
struct Moment {
  double time;
  RelativePlaces<double> places;
  ClosestPoints closest;
  double distance;

  Moment(const RelativeMotion& motion, double at)
      : time(at),
        places(places_at(motion, at)),
        closest(closest_points(places, motion.is_square)),
        distance(std::sqrt(closest.squared_distance)) {}
};

/// Components along `direction` of the corners of the differences. Two edges have four corners, a vertex and
/// a face the first three.
std::array<double, 4> corners_along(const Vec3d& direction, const RelativePlaces<double>& places) {
  const double m = dot(direction, places.m), u = dot(direction, places.u), w = dot(direction, places.w);
  return {m, m - u, m - w, m - u - w};
}

/// A bound of the magnitudes of all terms of a difference over the step, by axis.
Vec3d reach_of(const RelativeMotion& motion) {
  const auto& [start, end, is_square] = motion;
  return larger(absolute(start.m), absolute(end.m)) + larger(absolute(start.u), absolute(end.u)) +
         larger(absolute(start.w), absolute(end.w));
}

/// Whether the elements are proven to be farther apart than the separation between two times.
///
/// Let n move linearly from the closest direction at the first time to that at the last. The components of
/// the corners along n are then quadratic in time, and |n| is convex. The elements are apart where these
/// quadratics are above the separation times a bound of |n|, which their Bernstein coefficients prove. At
/// most 16 roundings of the magnitudes' sum take part: three for places, six for components and sums, three
/// for the mean.
bool apart_between(const Moment& first, const Moment& last, const RelativeMotion& motion, const Vec3d& reach,
                   double separation) {
  const Vec3d &n0 = first.closest.difference, &n1 = last.closest.difference;
  const double slack = 0x1p-48 * dot(larger(absolute(n0), absolute(n1)), reach) + 0x1p-900;
  // The addend covers squares that underflow.
  const auto bound = [&](const Vec3d& n) {
    return separation > 0 ? separation * std::sqrt(dot(n, n) + 0x1p-900) * (1 + 0x1p-49) : 0;
  };
  const double least0 = bound(n0) + slack, least1 = bound(n1) + slack;
  const std::array<double, 4> c00 = corners_along(n0, first.places), c01 = corners_along(n0, last.places);
  const std::array<double, 4> c10 = corners_along(n1, first.places), c11 = corners_along(n1, last.places);
  for (std::size_t i = 0; i < (motion.is_square ? 4 : 3); ++i) {
    if (!(c00[i] > least0 && c11[i] > least1 && (c01[i] + c10[i]) / 2 > (least0 + least1) / 2)) return false;
  }
  return true;
}

/// A proven bound of the distance. Each coordinate of the difference takes at most 12 roundings, its length
/// 8.
double most_distance(const Moment& moment, const Vec3d& reach) {
  return moment.distance * (1 + 0x1p-49) + 0x1p-46 * (reach.x + reach.y + reach.z) + 0x1p-500;
}

bool surely_touching(const Moment& moment, const Vec3d& reach, double separation) {
  return most_distance(moment, reach) < separation;
}

/// When the distance reaches the separation at its present rate of change; after the step when it grows.
double expected_time(const Moment& moment, const RelativeMotion& motion, double separation) {
  const auto& [start, end, is_square] = motion;
  const ClosestPoints& at = moment.closest;
  const Vec3d velocity = (end.m - start.m) - at.alpha * (end.u - start.u) - at.beta * (end.w - start.w);
  const double rate = dot(velocity, at.difference) / moment.distance;
  return rate < 0 ? moment.time + (moment.distance - separation) / -rate : 2;
}

/// Conservative advancement along a direction that turns with the elements. Converges quadratically to the
/// time at which they touch.
Outcome advance(const RelativeMotion& motion, double separation, double& time) {
  constexpr int most_steps = 200;  // some microseconds, where algebra takes hundreds
  const Vec3d reach = reach_of(motion);
  time = 0;
  Moment here(motion, 0);
  if (!apart_between(here, here, motion, reach, separation)) {
    return surely_touching(here, reach, separation) ? Outcome::touching : Outcome::unsure;
  }
  double farthest = 1;  // time worth trying
  for (int step = 0; step < most_steps; ++step) {
    const double expected = expected_time(here, motion, separation);
    // Stays short of the expected time, because nothing can be proven beyond it.
    double next = std::min(expected - (expected - time) / 16, farthest);
    const double closing = std::min(toi_tolerance, toi_relative_tolerance * time) / 4;
    const bool is_closing = !(next - time > closing);
    if (is_closing) next = std::min(time + closing, 1.0);
    const Moment there(motion, next);
    if (apart_between(here, there, motion, reach, separation)) {
      if (next == 1) return Outcome::apart;
      farthest = std::min(1.0, next + 8 * (next - time));
      time = next;
      here = there;
      continue;
    }
    if (is_closing) {
      const bool touching =
          surely_touching(there, reach, separation) ||
          surely_touching(Moment(motion, std::min(time + 2 * closing, 1.0)), reach, separation);
      return touching ? Outcome::touching : Outcome::unsure;
    }
    farthest = time + (next - time) / 4;
  }
  return Outcome::unsure;
}

/// The part of a step in which elements move by a few times their size, a power of two; 1 when the whole step
/// is not many times longer. Error bounds are relative to the longest vectors, so those of a part are
/// tighter. Its end has three more roundings, for which the bounds of `advance` have room.
double wild_part(const RelativeMotion& motion) {
  const auto& [start, end, is_square] = motion;
  const double size = largest_magnitude(start.m) + largest_magnitude(start.u) + largest_magnitude(start.w);
  const double reach = largest_magnitude(reach_of(motion));
  constexpr double wild = 0x1p6, longest = 0x1p100;
  if (!(reach > wild * size) || !(reach < longest * size)) return 1;
  return std::ldexp(1.0, 2 - std::ilogb(reach / size));
}

}  // namespace

RelativePlaces<double> places_at(const RelativeMotion& motion, double time) {
  return {mix(motion.start.m, motion.end.m, time), mix(motion.start.u, motion.end.u, time),
          mix(motion.start.w, motion.end.w, time)};
}

/// No difference is shorter than its component along the closest direction, whose roundings are those of
/// `apart_between`.
DistanceBounds distance_bounds(const RelativeMotion& motion, double time) {
  const auto& [start, end, is_square] = motion;
  const auto size = [](const RelativePlaces<double>& places) {
    return absolute(places.m) + absolute(places.u) + absolute(places.w);
  };
  const Vec3d reach = mix(size(start), size(end), time);
  const Moment moment(motion, time);
  const Vec3d& n = moment.closest.difference;
  const std::array<double, 4> along = corners_along(n, moment.places);
  const double least = *std::min_element(along.begin(), along.begin() + (motion.is_square ? 4 : 3)) -
                       (0x1p-48 * dot(absolute(n), reach) + 0x1p-900);
  const double length = std::sqrt(dot(n, n) + 0x1p-900) * (1 + 0x1p-49);
  return {least > 0 ? least / length * (1 - 0x1p-50) : 0, most_distance(moment, reach), (1 / length) * n};
}

ImpactSearch search_impact(const RelativeMotion& motion, double separation) {
  ImpactSearch search;
  if (separation == 0) {
    MotionBlock block;
    CoplanarSearch coplanar;
    block.set(0, motion);
    search_coplanar_times(block, 1, motion.is_square, coplanar);
    if (coplanar.apart != 0) return {Outcome::apart};
    if (coplanar.touching != 0) return {Outcome::touching, coplanar.times[0]};
  }
  const double part = wild_part(motion);
  if (part < 1) {
    search.outcome = advance(part_of_motion(motion, static_cast<float>(part)), separation, search.time);
    search.time *= part;
    if (search.outcome != Outcome::apart) return search;
  }
  search.outcome = advance(motion, separation, search.time);
  return search;
}

}  // namespace supple
