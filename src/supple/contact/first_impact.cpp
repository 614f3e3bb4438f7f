#include "contact/first_impact.hpp"

#include <algorithm>
#include <cmath>

#include "contact/closest_points.hpp"
#include "contact/exact_impact.hpp"
#include "contact/impact_search.hpp"
#include "geometry/vector.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {
namespace {

/// The vector divided by its largest coordinate, so that squares neither overflow nor underflow, or 0 when it
/// has no direction.
Vec3d scaled(const Vec3d& v) {
  const double size = largest_magnitude(v);
  if (!(size > 0) || !std::isfinite(size)) return {};
  return {v.x / size, v.y / size, v.z / size};
}

/// A vector of length 1, or 0 when `v` has no direction.
Vec3d normalized(const Vec3d& v) {
  const Vec3d s = scaled(v);
  return s == Vec3d{} ? s : (1 / std::sqrt(dot(s, s))) * s;
}

/// A product smaller than this fraction of the magnitudes of its terms has no reliable direction.
constexpr double negligible = 0x1p-40;

/// The unit vector across both elements, towards the side from which the first element came: against its
/// velocity, or else towards its position at the start.
Vec3d normal_across(const RelativeMotion& motion, const RelativePlaces<double>& places,
                    const ClosestPoints& at) {
  const Vec3d product = cross(scaled(places.u), scaled(places.w));
  const Vec3d n = dot(product, product) > negligible * negligible ? normalized(product) : Vec3d{};
  const Vec3d velocity = (motion.end.m - motion.start.m) - at.alpha * (motion.end.u - motion.start.u) -
                         at.beta * (motion.end.w - motion.start.w);
  const double approach = dot(n, scaled(velocity));
  if (std::fabs(approach) > negligible) return approach < 0 ? n : -1.0 * n;
  const Vec3d before = motion.start.m - at.alpha * motion.start.u - at.beta * motion.start.w;
  const double side = dot(n, scaled(before));
  if (std::fabs(side) > negligible) return side > 0 ? n : -1.0 * n;
  // The motion stays in one plane or on one line. Point back to where the element came from, or else against
  // its velocity.
  if (scaled(before) != Vec3d{}) return normalized(before);
  if (velocity != Vec3d{}) return -1.0 * normalized(velocity);
  return n;
}

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

Impact impact_at(const ElementMotion& motion, const RelativeMotion& relative, double time,
                 double separation) {
  const Scaled places(places_at(relative, time));
  const ClosestPoints at = closest_points(places.places, relative.is_square);
  Impact impact;
  impact.toi = time;
  std::array<Vec3d, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = mix(motion.start[i], motion.end[i], time);
  if (relative.is_square) {
    impact.barycentric = {1 - at.alpha, at.alpha, 1 - at.beta, at.beta};
    impact.point = 0.5 * (mix(p[0], p[1], at.alpha) + mix(p[2], p[3], at.beta));
  } else {
    impact.barycentric = {1, std::max(0.0, 1 - at.alpha - at.beta), at.alpha, at.beta};
    impact.point = 0.5 * (p[0] + (impact.barycentric[1] * p[1] + at.alpha * p[2] + at.beta * p[3]));
  }
  // The vector between the elements is accurate when they are apart, but not when they touch.
  const bool apart = separation > 0 && std::sqrt(at.squared_distance) > 0.5 * places.factor * separation;
  impact.normal = apart ? normalized(at.difference) : normal_across(relative, places.places, at);
  return impact;
}

std::optional<Impact> checked_first_impact(const ElementMotion& motion, const ImpactOptions& options) {
  check(options, "first_impact");
  if (!std::ranges::all_of(motion.start, is_finite) || !std::ranges::all_of(motion.end, is_finite)) return {};
  bool used_exact = false;
  return first_impact_of_finite(motion, options, used_exact);
}

}  // namespace

std::optional<Impact> first_impact_of_finite(const ElementMotion& motion, const ImpactOptions& options,
                                             bool& used_exact) {
  const RelativeMotion relative = relative_motion(motion);
  return first_impact_after(search_impact(relative, options.min_separation), motion, relative, options,
                            used_exact);
}

std::optional<Impact> first_impact_after(const ImpactSearch& search, const ElementMotion& motion,
                                         const RelativeMotion& relative, const ImpactOptions& options,
                                         bool& used_exact) {
  const double separation = options.min_separation;
  if (search.outcome == ImpactSearch::Outcome::apart) return std::nullopt;
  if (search.outcome == ImpactSearch::Outcome::touching) {
    return impact_at(motion, relative, search.time, separation);
  }
  used_exact = true;
  if (!options.exact) {
    Impact impact = impact_at(motion, relative, search.time, separation);
    impact.certainty = ImpactCertainty::within_tolerance;
    return impact;
  }
  const std::optional<TimeBracket> first =
      separation == 0 ? exact_first_contact(motion) : exact_first_contact(motion, separation);
  if (!first) return std::nullopt;
  return impact_at(motion, relative, first->low, separation);
}

std::optional<Impact> first_impact(const VertexFaceMotion& motion, const ImpactOptions& options) {
  return checked_first_impact(motion, options);
}
std::optional<Impact> first_impact(const EdgeEdgeMotion& motion, const ImpactOptions& options) {
  return checked_first_impact(motion, options);
}

}  // namespace supple
