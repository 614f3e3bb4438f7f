#include "contact/impact/safe_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

#include "contact/distance/element_distance.hpp"
#include "contact/impact/first_impact.hpp"
#include "contact/impact/impact_search.hpp"
#include "geometry/numbers/double_double.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// A motion times a power of two, so that products of coordinates neither overflow nor underflow. Coordinates
/// that vanish are far below the rounding of the others.
struct ScaledMotion {
  ElementMotion motion;
  KeptDistance kept;
  double factor = 1;

  ScaledMotion(const ElementMotion& unscaled, const KeptDistance& unscaled_kept)
      : motion(unscaled), kept(unscaled_kept) {
    const double size = largest_coordinate(motion);
    if (size == 0 || (size < 0x1p100 && size > 0x1p-100)) return;
    const int exponent = std::clamp(-std::ilogb(size), -1000, 1000);
    factor = std::ldexp(1.0, exponent);
    for (auto* moment : {&motion.start, &motion.end}) {
      for (Vec3d& p : *moment) p = scaled(p, exponent);
    }
    kept.separation = kept.separation * factor;
  }
};

constexpr double smallest = std::numeric_limits<double>::denorm_min();

/// Bounds of the distance that elements keep.
struct KeptBounds {
  double low = 0, high = 0;
};

/// `is_beyond`: the elements are farther apart than the separation at the start.
KeptBounds kept_bounds(const DistanceBounds& distance, const KeptDistance& kept, bool is_beyond) {
  constexpr double less = 1 - 0x1p-50, more = 1 + 0x1p-50;
  const double base = is_beyond ? kept.separation : 0;
  if (base == 0 && kept.keep == 0) return {};
  const double low = std::max(distance.low - base, 0.0) * less, high = (distance.high - base) * more;
  return {(base + kept.keep * low * less) * less - smallest,
          (base + kept.keep * high * more) * more + smallest};
}

bool is_beyond(const DistanceBounds& distance, const ScaledMotion& scaled, const ElementMotion& motion,
               const KeptDistance& kept) {
  if (distance.low > scaled.kept.separation * (1 + 0x1p-50) + smallest) return true;
  return kept.separation == 0 || !are_within(motion, kept.separation);
}

/// Whether the time of the search is early by no more than 2^-18 of the time at which the elements are at the
/// distance that they keep. The search looked for its upper bound.
bool is_precise(const ImpactSearch& search, const RelativeMotion& relative, const KeptBounds& least) {
  if (search.outcome != ImpactSearch::Outcome::touching || !(search.time > 0)) return false;
  const double later = std::min(search.time * (1 + 3 * 0x1p-20), 1.0);
  return least.high == 0 || distance_bounds(relative, later).high <= least.low;
}

/// end - start = end_of_other - start_of_other, without rounding.
bool have_same_way(const Vec3d& start, const Vec3d& end, const Vec3d& start_of_other,
                   const Vec3d& end_of_other) {
  const auto way = [](double from, double to) {
    const double factor = std::isfinite(to - from) ? 1 : 0.25;
    const DoubleDouble sum = exact_sum(factor * to, -factor * from);
    return std::tuple(sum.high, sum.low, factor);
  };
  for (int axis = 0; axis < 3; ++axis) {
    if (way(start[axis], end[axis]) != way(start_of_other[axis], end_of_other[axis])) return false;
  }
  return true;
}

/// The most by which points of the elements come nearer along a direction from the second to the first, where
/// each element moves by at least `least` towards the other.
double approach_along(const Vec3d& direction, const ElementMotion& motion, double least) {
  double most_a = least, most_b = least, longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d way = motion.end[i] - motion.start[i];
    const bool is_of_a = i < (motion.are_edges ? 2u : 1u);
    double& most = is_of_a ? most_a : most_b;
    most = std::max(most, dot(is_of_a ? -1.0 * way : way, direction));
    longest = std::max(longest, scaled_norm(way));
  }
  return std::max(most_a + most_b, 0.0) * (1 + 0x1p-40) + rounding_of_ways * longest;
}

}  // namespace

/// Along the direction between the closest points at the start, they come nearer by at most `approach`.
SafeTime safe_time(const ElementMotion& motion, const KeptDistance& kept, double latest, bool exact) {
  const ScaledMotion scaled(motion, kept);
  const RelativeMotion relative = relative_motion(scaled.motion);
  const DistanceBounds start = distance_bounds(relative, 0);
  if (start.low == 0 && touch_at_start(motion)) {
    constexpr double any = std::numeric_limits<double>::infinity();
    return {{}, any, false, !touch_at_rest(motion)};
  }
  const bool beyond = is_beyond(start, scaled, motion, kept);
  const KeptBounds least = kept_bounds(start, scaled.kept, beyond);
  constexpr double any_way = -std::numeric_limits<double>::max() / 4;
  const double approach = approach_along(start.direction, scaled.motion, any_way);
  SafeTime result{{}, std::max(least.low, start.low - latest * approach) / scaled.factor, false, false};
  if (start.low - approach > least.high) return result;
  const ImpactSearch search = search_impact(relative, least.high);
  if (search.outcome == ImpactSearch::Outcome::apart) return result;
  result.time = search.time;
  if (!exact || search.time > latest || is_precise(search, relative, least)) return result;
  result.used_exact = true;
  const std::optional<TimeBracket> first = exact_first_contact(motion, kept);
  result.time = first ? std::optional(first->low) : std::nullopt;
  return result;
}

/// Along the direction between the closest points at the start, the elements come nearer by at most the sum
/// of what each moves towards the other.
double free_part(const ElementMotion& motion, const KeptDistance& kept, double rounding, double growth) {
  const ScaledMotion scaled(motion, kept);
  const DistanceBounds start = distance_bounds(relative_motion(scaled.motion), 0);
  const double approach = approach_along(start.direction, scaled.motion, 0) + 2 * growth * scaled.factor;
  const double beyond = start.low - (is_beyond(start, scaled, motion, kept) ? scaled.kept.separation : 0);
  const double room = std::max(beyond * (1 - kept.keep) * (1 - 0x1p-40), 0.0) - 2 * rounding * scaled.factor;
  return approach > 0 ? std::clamp(room / approach * (1 - 0x1p-40), 0.0, 1.0) : 1;
}

bool touch_at_start(const ElementMotion& motion) {
  const auto first_of_b = motion.start.begin() + (motion.are_edges ? 2 : 1);
  if (std::find_first_of(motion.start.begin(), first_of_b, first_of_b, motion.start.end()) != first_of_b)
    return true;
  ElementMotion at_start = motion;
  at_start.end = at_start.start;
  return exact_first_contact(at_start).has_value();
}

bool touch_at_rest(const ElementMotion& motion) {
  const auto moves_with = [&](std::size_t i, std::size_t k) {
    return have_same_way(motion.start[i], motion.end[i], motion.start[k], motion.end[k]);
  };
  std::size_t same = 0;
  for (std::size_t i = 0, count = motion.are_edges ? 2 : 1; i < count; ++i) {
    for (std::size_t k = count; k < 4; ++k) same += moves_with(i, k) ? 1 : 0;
  }
  if (same == 0 || same == (motion.are_edges ? 4u : 3u)) return same != 0;
  bool used_exact = false;
  const auto touching =
      closest_features_within(element_points(motion.start, motion.are_edges), 0, used_exact);
  if (!touching) return false;
  const bool are_vertices = touching->kind == ClosestFeatures::Kind::vertices;
  const std::array<std::size_t, 3> vertices{touching->vertex, touching->edge[0],
                                            are_vertices ? touching->vertex : touching->edge[1]};
  if (touching->kind == ClosestFeatures::Kind::interiors)
    return moves_with(1, 0) && moves_with(2, 0) && moves_with(3, 0);
  return moves_with(vertices[1], vertices[0]) && moves_with(vertices[2], vertices[0]);
}

}  // namespace supple
