#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace supple {

/// A margin of at least one and at most two ulps of float at `value`. It adds the smallest normal number, so
/// that it covers values near 0 even in programs that flush denormals.
inline float outward_step(float value) {
  return std::abs(value) * 0x1p-23f + std::numeric_limits<float>::min();
}

/// Rounds down: returns `value` when it is a float, otherwise a float at most three ulps below. Values below
/// the range of float give -inf; NaN stays NaN. The vector kernels compute the same bits.
inline float round_down(double value) {
  const float nearest = std::min(static_cast<float>(value), std::numeric_limits<float>::max());
  return static_cast<double>(nearest) > value ? nearest - outward_step(nearest) : nearest;
}

/// Rounds up in the same way. Values above the range of float give +inf.
inline float round_up(double value) {
  const float nearest = std::max(static_cast<float>(value), -std::numeric_limits<float>::max());
  return static_cast<double>(nearest) < value ? nearest + outward_step(nearest) : nearest;
}

}  // namespace supple
