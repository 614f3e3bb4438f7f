#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "supple/types.hpp"

namespace supple::viewer {

/// A point that is subtracted from positions in double, so that floats are precise far from the origin.
struct Center {
  Vec3d at{};

  /// NaN where the result does not fit a float.
  std::array<float, 3> operator()(const Vec3d& p) const {
    return {narrow(p.x - at.x), narrow(p.y - at.y), narrow(p.z - at.z)};
  }
  std::array<float, 3> operator()(const Vec3f& p) const { return (*this)(Vec3d{p.x, p.y, p.z}); }
  Vec3d back(const Vec3d& p) const { return p + at; }

  static float narrow(double value) {
    constexpr double largest = std::numeric_limits<float>::max();
    return std::fabs(value) <= largest ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
  }
};

}  // namespace supple::viewer
