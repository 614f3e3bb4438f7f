#pragma once

#include <array>
#include <span>

#include "contact/relative_motion.hpp"

namespace supple {

/// The volume m · (u × w) of the four vertices over the step: elements can touch only where it is zero.
/// Bernstein coefficients of a cubic in [0, 1], and what they, and values between them, may be off by.
class VolumePolynomial {
 public:
  explicit VolumePolynomial(const RelativeMotion& motion);

  /// False for coordinates so large that products may overflow: nothing here is then of use.
  bool in_range() const { return in_range_; }

  double value(double t) const;
  /// Not zero anywhere in [low, high], without doubt.
  bool never_zero(double low, double high) const;
  /// The values at both ends have different signs, without doubt.
  bool changes_sign(double low, double high) const;

  /// Short closed intervals of time, ascending, outside of which the volume has no zeros as far as floating
  /// point can see; `never_zero` proves it for each gap.
  struct Interval {
    double low, high;
  };
  struct Intervals {
    std::array<Interval, 7> items;
    std::size_t count = 0;
    std::span<const Interval> all() const { return {items.data(), count}; }
  };
  Intervals near_zeros() const;

 private:
  /// Plain values, and slopes, by the powers of t.
  double estimate(double t) const {
    return ((powers_[3] * t + powers_[2]) * t + powers_[1]) * t + powers_[0];
  }
  double slope(double t) const { return (3 * powers_[3] * t + 2 * powers_[2]) * t + powers_[1]; }
  /// The one zero of a stretch of time over which the value grows or falls and changes its sign.
  double zero_between(double low, double high, double at_low, double at_high) const;
  void add_turning_points(std::array<double, 4>& knots, std::size_t& count) const;

  std::array<double, 4> coefficients_, powers_;
  double error_;
  bool in_range_;
};

}  // namespace supple
