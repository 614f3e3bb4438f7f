#pragma once

#include <array>
#include <span>

#include "contact/impact/relative_motion.hpp"

namespace supple {

/// The volume m · (u × w) of the four vertices over the step, a cubic polynomial. Elements can touch only
/// where it is 0. Holds its Bernstein coefficients on [0, 1] and a bound of the error of all values.
class VolumePolynomial {
 public:
  explicit VolumePolynomial(const RelativeMotion& motion);

  /// False when coordinates are so large that products may overflow. All other results are then undefined.
  bool in_range() const { return in_range_; }

  double value(double t) const;
  /// Whether the volume is proven not to be 0 anywhere in [low, high].
  bool never_zero(double low, double high) const;
  /// For elements that touch at the start: whether the volume is proven not to be 0 after it, or to be 0
  /// always.
  bool never_or_always_zero_after_start() const;
  /// Whether the values at both ends are proven to have different signs.
  bool changes_sign(double low, double high) const;

  /// Short closed intervals of time, ascending. Outside them the volume has no zeros up to rounding;
  /// `never_zero` proves this for a gap.
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
  /// Values and slopes without error bounds.
  double estimate(double t) const {
    return ((powers_[3] * t + powers_[2]) * t + powers_[1]) * t + powers_[0];
  }
  double slope(double t) const { return (3 * powers_[3] * t + 2 * powers_[2]) * t + powers_[1]; }
  /// The zero in an interval over which the value is monotonic and changes its sign.
  double zero_between(double low, double high, double at_low, double at_high) const;
  void add_turning_points(std::array<double, 4>& knots, std::size_t& count) const;

  std::array<double, 4> coefficients_, powers_;
  double error_;
  bool in_range_, always_zero_;
};

}  // namespace supple
