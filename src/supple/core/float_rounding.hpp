#pragma once

#include <cmath>
#include <limits>

namespace supple {

/// Largest float that is not above `value`. Values below the range of float give -inf; NaN stays NaN.
inline float round_down(double value) {
  const float nearest = static_cast<float>(value);
  return static_cast<double>(nearest) <= value
             ? nearest
             : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

/// Smallest float that is not below `value`. Values above the range of float give +inf; NaN stays NaN.
inline float round_up(double value) {
  const float nearest = static_cast<float>(value);
  return static_cast<double>(nearest) >= value
             ? nearest
             : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

}  // namespace supple
