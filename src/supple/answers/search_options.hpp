#pragma once

#include <algorithm>
#include <limits>

#include "geometry/vector.hpp"
#include "supple/options.hpp"

namespace supple {

/// The distance within which elements of the two objects are near.
inline double reach_of_margins(double margin_a, double margin_b) {
  return std::min(margin_a + margin_b, std::numeric_limits<double>::max());
}

/// The distance at which elements of two objects touch.
inline double separation_of(double of_scene, double of_a, double of_b) {
  return std::min(of_scene + (of_a + of_b), std::numeric_limits<double>::max());
}

/// What a search for continuous contacts finds.
struct ImpactSearchOptions {
  ImpactOptions impact;
  ElementKinds kinds = ElementKinds::all;
  ContinuousListing listing = ContinuousListing::all;
};

/// Two elements that come nearer by d, and then keep less than `StepOptions::keep` of their distance, are
/// within d times this share of each other.
inline double kept_share(const StepOptions& step) {
  return step.keep / (1 - step.keep);
}

/// Two vertices at from + t (to - from), computed in double, come nearer by rounding by less than this share
/// of their largest coordinate at the start plus t times their longest way: each coordinate takes three
/// roundings of at most 2^-53 of |from| + 2 t |to - from|.
constexpr double safe_step_rounding = 0x1p-48;

/// Where a vertex moves by this part, as users compute it. Ways that overflow take another formula.
inline Vec3d rounded_position(const Vec3d& start, const Vec3d& end, double part) {
  const Vec3d position = start + part * (end - start);
  return is_finite(position) ? position : mix(start, end, part);
}

}  // namespace supple
