#include "contact/impact/first_impact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "contact/distance/closest_points.hpp"
#include "contact/distance/element_distance.hpp"
#include "contact/impact/exact_impact.hpp"
#include "contact/impact/impact_filter.hpp"
#include "contact/impact/impact_search.hpp"
#include "core/float_rounding.hpp"
#include "geometry/numbers/double_double.hpp"
#include "geometry/vector.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {

ElementPoints element_points(const std::array<Vec3d, 4>& points, bool are_edges) {
  if (are_edges) return {points, 2, 2};
  return {points, 1, 3};
}

namespace {

/// Places times a power of two, so that products of coordinates do not overflow or underflow.
struct Scaled {
  double factor = 1;
  RelativePlaces<double> places;

  explicit Scaled(const RelativePlaces<double>& unscaled) : places(unscaled) {
    const double size =
        largest_magnitude(larger(larger(absolute(unscaled.m), absolute(unscaled.u)), absolute(unscaled.w)));
    if (!(size > 0x1p100 || size < 0x1p-100) || size == 0) return;
    factor = std::ldexp(1.0, std::clamp(-std::ilogb(size), -1000, 1000));
    places = {factor * unscaled.m, factor * unscaled.u, factor * unscaled.w};
  }
};

/// Where two elements are closest.
struct Gap {
  double alpha = 0, beta = 0, distance = 0;
  Vec3d normal;  ///< unit vector between the closest points, or 0 where these coincide
};

/// Uses the relative positions of the elements. `points` gives their positions where double precision is not
/// enough: where the elements are close compared with their size, edges that are nearly parallel have no
/// accurate closest points in double precision.
template <class Points>
Gap gap_between(const RelativePlaces<double>& relative, bool is_square, const Points& points) {
  const Scaled scaled(relative);
  const auto& [m, u, w] = scaled.places;
  const double size = largest_magnitude(larger(larger(absolute(m), absolute(u)), absolute(w)));
  const ClosestPoints at = closest_points(scaled.places, is_square);
  const double distance = std::sqrt(at.squared_distance);
  if (distance > 0x1p-12 * size)
    return {at.alpha, at.beta, distance / scaled.factor, (1 / distance) * at.difference};
  bool used_exact = false;
  const auto exact = distance_within(points(), any_distance, used_exact, DistanceAccuracy::rough);
  const auto& [a, b] = std::tie(exact->barycentric_a, exact->barycentric_b);
  return {is_square ? a[1] : b[1], is_square ? b[1] : b[2], exact->distance,
          exact->distance > 0 ? exact->normal : Vec3d{}};
}

Gap gap_at_start(const ElementMotion& motion, const RelativeMotion& relative) {
  return gap_between(relative.start, relative.is_square,
                     [&] { return element_points(motion.start, motion.are_edges); });
}

/// The gap at the time at which the elements come within the separation. Has no normal where rounding of the
/// places could change it.
Gap gap_at_impact(const RelativeMotion& relative, double time, double separation) {
  const RelativePlaces<double> places = places_at(relative, time);
  const Vec3d &m = places.m, &u = places.u, &w = places.w;
  Gap gap = gap_between(places, relative.is_square, [&] {
    return relative.is_square ? element_points({m, m - u, Vec3d{}, w}, true)
                              : element_points({m, Vec3d{}, u, w}, false);
  });
  const double size = largest_magnitude(larger(larger(absolute(m), absolute(u)), absolute(w)));
  if (!(separation > 0x1p-36 * size)) gap.normal = {};
  return gap;
}

/// A product smaller than this fraction of the magnitudes of its terms has no reliable direction.
constexpr double negligible = 0x1p-40;

/// The cross product of two vectors with coordinates of at most 1. Its direction is accurate also for vectors
/// that are nearly parallel.
Vec3d accurate_cross(const Vec3d& u, const Vec3d& w) {
  const auto component = [](double a, double b, double c, double d) {
    return static_cast<double>(exact_product(a, b) - exact_product(c, d));
  };
  return {component(u.y, w.z, u.z, w.y), component(u.z, w.x, u.x, w.z), component(u.x, w.y, u.y, w.x)};
}

/// A unit vector across a unit vector; in the plane z = 0 for lines in it.
Vec3d across(const Vec3d& along) {
  const Vec3d in_plane{along.y, -along.x, 0};
  return dot(in_plane, in_plane) > negligible ? normalized(in_plane) : Vec3d{1, 0, 0};
}

/// The unit vector across both elements, towards the side from which the first element came: against its
/// velocity, or else towards its position at the start, where the elements are apart there.
Vec3d normal_across(const RelativeMotion& motion, const RelativePlaces<double>& places, const Gap& at,
                    bool apart_at_start) {
  const Vec3d product = accurate_cross(scaled(places.u), scaled(places.w));
  const Vec3d n = dot(product, product) > negligible * negligible ? normalized(product) : Vec3d{};
  const Vec3d velocity = (motion.end.m - motion.start.m) - at.alpha * (motion.end.u - motion.start.u) -
                         at.beta * (motion.end.w - motion.start.w);
  const double approach = dot(n, scaled(velocity));
  if (std::fabs(approach) > negligible) return approach < 0 ? n : -1.0 * n;
  const Vec3d before =
      apart_at_start ? motion.start.m - at.alpha * motion.start.u - at.beta * motion.start.w : Vec3d{};
  const double side = dot(n, scaled(before));
  if (std::fabs(side) > negligible) return side > 0 ? n : -1.0 * n;
  // The motion stays in the plane of both elements.
  if (n != Vec3d{}) return n;
  // The elements are on one line, or points. The normal is across the line, unless they meet end to end.
  const Vec3d along = normalized(dot(places.u, places.u) < dot(places.w, places.w) ? places.w : places.u);
  for (const Vec3d& v : {before, -1.0 * velocity}) {
    const Vec3d rest = scaled(v) - dot(scaled(v), along) * along;
    if (dot(rest, rest) > negligible * negligible) return normalized(rest);
  }
  if (scaled(before) != Vec3d{}) return normalized(before);
  return along != Vec3d{} ? across(along) : Vec3d{};
}

/// As `impact_at`, where differences of coordinates do not overflow.
Impact moderate_impact_at(const ElementMotion& motion, const RelativeMotion& relative, double time,
                          bool touching_at_start, double separation) {
  const Scaled places(places_at(relative, time));
  Impact impact;
  impact.toi = time;
  impact.touching_at_start = touching_at_start;
  const bool share_point_at_start = touching_at_start && separation == 0;
  const Gap start = share_point_at_start ? Gap() : gap_at_start(motion, relative);
  impact.start_distance = start.distance;
  Gap gap = start;
  if (separation == 0) {
    const ClosestPoints at = closest_points(places.places, relative.is_square);
    gap = {at.alpha, at.beta, 0, {}};
  } else if (time > 0) {
    gap = gap_at_impact(relative, time, separation);
  }
  std::array<Vec3d, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = mix(motion.start[i], motion.end[i], time);
  if (relative.is_square) {
    impact.barycentric = {1 - gap.alpha, gap.alpha, 1 - gap.beta, gap.beta};
    impact.point = 0.5 * (mix(p[0], p[1], gap.alpha) + mix(p[2], p[3], gap.beta));
  } else {
    impact.barycentric = {1, std::max(0.0, 1 - gap.alpha - gap.beta), gap.alpha, gap.beta};
    impact.point = 0.5 * (p[0] + (impact.barycentric[1] * p[1] + gap.alpha * p[2] + gap.beta * p[3]));
  }
  const bool is_apart_at_start = time > 0 || start.distance > 0;
  impact.normal =
      gap.normal != Vec3d{} ? gap.normal : normal_across(relative, places.places, gap, is_apart_at_start);
  return impact;
}

/// The impact of elements that first touch at `time`; at 0 they may also be apart by less than rounding can
/// tell.
Impact impact_at(const ElementMotion& motion, const RelativeMotion& relative, double time,
                 bool touching_at_start, double separation) {
  constexpr double largest = 0x1p1015, factor = 0x1p-8;
  if (largest_coordinate(motion) <= largest)
    return moderate_impact_at(motion, relative, time, touching_at_start, separation);
  ElementMotion smaller = motion;
  for (auto* places : {&smaller.start, &smaller.end}) {
    for (Vec3d& p : *places) p = factor * p;
  }
  Impact impact =
      moderate_impact_at(smaller, relative_motion(smaller), time, touching_at_start, factor * separation);
  // Rounding could lead beyond the largest double, and so can a distance.
  impact.start_distance = restored(impact.start_distance, factor);
  impact.point = restored(impact.point, factor);
  return impact;
}

std::optional<Impact> impact_after(const ImpactSearch& search, const ElementMotion& motion,
                                   const RelativeMotion& relative, const ImpactOptions& options,
                                   bool& used_exact) {
  const double separation = options.min_separation;
  if (search.outcome == ImpactSearch::Outcome::apart) return std::nullopt;
  if (search.outcome == ImpactSearch::Outcome::touching) {
    return impact_at(motion, relative, search.time, search.time == 0, separation);
  }
  used_exact = true;
  if (!options.exact) {
    const bool at_start = search.time == 0 && are_within(motion, separation);
    Impact impact = impact_at(motion, relative, search.time, at_start, separation);
    impact.certainty = ImpactCertainty::within_tolerance;
    return impact;
  }
  const std::optional<TimeBracket> first =
      separation == 0 ? exact_first_contact(motion) : exact_first_contact(motion, separation);
  if (!first) return std::nullopt;
  return impact_at(motion, relative, first->low, first->high == 0, separation);
}

/// Whether elements that are apart at the start, within the separation, part.
bool part(const Impact& impact, const ElementMotion& motion, const RelativeMotion& relative,
          const ImpactOptions& options, bool& used_exact) {
  if (!impact.touching_at_start || !(impact.start_distance > 0)) return false;
  const double least = impact.start_distance * (1 - 0x1p-10);
  const std::optional<double> time = first_time_within(motion, relative, least, options.exact, used_exact);
  return !time || *time > options.max_time;
}

}  // namespace

std::optional<double> first_time_within(const ElementMotion& motion, const RelativeMotion& relative,
                                        double separation, bool exact, bool& used_exact) {
  const ImpactSearch search = search_impact(relative, separation);
  if (search.outcome == ImpactSearch::Outcome::apart) return std::nullopt;
  if (search.outcome == ImpactSearch::Outcome::touching || !exact) return search.time;
  used_exact = true;
  const auto first = separation == 0 ? exact_first_contact(motion) : exact_first_contact(motion, separation);
  return first ? std::optional(first->low) : std::nullopt;
}

float end_of_search(const ImpactOptions& options) {
  return std::min(1.0f, round_up(options.max_time + toi_tolerance));
}

float latest_true_time(double time) {
  constexpr double relative_tolerance = 0x1p-17;  // of safe steps, with some slack
  return std::min(1.0f, round_up(time * (1 + relative_tolerance) + std::numeric_limits<double>::min()));
}

std::optional<Impact> first_impact_after(const ImpactSearch& search, const ElementMotion& motion,
                                         const RelativeMotion& relative, const ImpactOptions& options,
                                         bool& used_exact) {
  const std::optional<Impact> impact = impact_after(search, motion, relative, options, used_exact);
  if (!impact || impact->toi > options.max_time) return std::nullopt;
  if (options.skip_parting && part(*impact, motion, relative, options, used_exact)) return std::nullopt;
  return impact;
}

bool are_within(const ElementMotion& motion, double separation) {
  bool used_exact = false;
  return distance_within(element_points(motion.start, motion.are_edges), separation, used_exact,
                         DistanceAccuracy::rough)
      .has_value();
}

namespace {

/// Whether a vector kernel proves that the elements touch after `until`.
bool touch_later(const RelativeMotion& motion, float until, double separation) {
  RelativeMotionBlock block;
  block.set(0, part_of_motion(motion, until));
  return may_touch(block, 1, motion.is_square, round_up(separation)) == 0;
}

std::optional<Impact> checked_first_impact(const ElementMotion& motion, const ImpactOptions& options) {
  check(options, "first_impact");
  if (!std::ranges::all_of(motion.start, is_finite) || !std::ranges::all_of(motion.end, is_finite)) return {};
  const RelativeMotion relative = relative_motion(motion);
  const float until = end_of_search(options);
  if (until < 1 && touch_later(relative, until, options.min_separation)) return {};
  bool used_exact = false;
  return first_impact_after(search_impact(relative, options.min_separation), motion, relative, options,
                            used_exact);
}

}  // namespace

std::optional<Impact> first_impact(const VertexFaceMotion& motion, const ImpactOptions& options) {
  return checked_first_impact(motion, options);
}
std::optional<Impact> first_impact(const EdgeEdgeMotion& motion, const ImpactOptions& options) {
  return checked_first_impact(motion, options);
}
std::optional<Impact> first_impact(const PointPointMotion& motion, const ImpactOptions& options) {
  std::optional<Impact> impact = checked_first_impact(motion, options);
  if (impact) impact->barycentric = {1, 1, 0, 0};
  return impact;
}
std::optional<Impact> first_impact(const PointEdgeMotion& motion, const ImpactOptions& options) {
  std::optional<Impact> impact = checked_first_impact(motion, options);
  if (impact) {
    auto& [point, start, end, same_end] = impact->barycentric;
    end += std::exchange(same_end, 0);
  }
  return impact;
}

}  // namespace supple
