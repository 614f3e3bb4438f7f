#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace supple {

/// Room of at least one ulp of float at `value`, two at most. The smallest normal number rather than a
/// denormal covers the neighbourhood of 0 even where a program flushes denormals.
inline float outward_step(float value) {
  return std::abs(value) * 0x1p-23f + std::numeric_limits<float>::min();
}

/// A float that is not above `value`: `value` itself when it is a float, else within three ulps below. Values
/// below the range of float give -inf; NaN stays NaN. The vector kernels compute the same bits.
inline float round_down(double value) {
  const float nearest = std::min(static_cast<float>(value), std::numeric_limits<float>::max());
  return static_cast<double>(nearest) > value ? nearest - outward_step(nearest) : nearest;
}

/// A float that is not below `value`, likewise. Values above the range of float give +inf.
inline float round_up(double value) {
  const float nearest = std::max(static_cast<float>(value), -std::numeric_limits<float>::max());
  return static_cast<double>(nearest) < value ? nearest + outward_step(nearest) : nearest;
}

}  // namespace supple
