#pragma once

#include <optional>

#include "contact/impact/exact_impact.hpp"
#include "contact/impact/relative_motion.hpp"

namespace supple {

/// The differences of ways are rounded, which counts where vertices move together.
constexpr double rounding_of_ways = 0x1p-50;

/// How two elements limit a safe step.
struct SafeTime {
  /// Never later than the first time at which the elements are at the distance that they keep, and earlier by
  /// at most 2^-18 of it; nothing when they are farther apart in the whole step.
  std::optional<double> time;
  /// A lower bound of their distance up to `latest`, or up to `time` when that is earlier.
  double least_distance = 0;
  bool used_exact = false;
  /// The elements touch at the start and do not move together. The start is no time that limits the step:
  /// `part_after_start` decides that.
  bool touches = false;
};

/// Elements that touch at the start have no time. `motion` is finite. Without `exact` the time may be
/// earlier, and there may be one when there is none. A time after `latest` may be early, too.
SafeTime safe_time(const ElementMotion& motion, const KeptDistance& kept, double latest, bool exact);

/// A part, 0 to 1, up to which two elements surely keep their distance when they move by any two parts of
/// their ways. They then also stay farther apart than `rounding` plus the part times `growth`.
double free_part(const ElementMotion& motion, const KeptDistance& kept, double rounding, double growth);

/// Whether elements share a point at the start.
bool touch_at_start(const ElementMotion& motion);

/// Whether elements that touch at the start do not move against each other: the vertices of the features that
/// touch, as `ElementDistance` names them, move by exactly the same way.
bool touch_at_rest(const ElementMotion& motion);

}  // namespace supple
