#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "contact/impact/step_polynomial.hpp"
#include "supple/continuous.hpp"

namespace supple {

/// Integers for coordinates whose differences are below 2^(64 limbs - 3), and for times n / 2^k, k ≤ finest.
/// Quadratic polynomials then have coefficients below 2^(128 limbs - 2), cubic ones below 2^(192 limbs - 3).
/// Values at a time are multiplied by 2^k for each degree.
template <std::size_t limbs>
struct FixedNumbers {
  static constexpr int finest = 120;
  using Length = WideInteger<limbs>;
  using Area = WideInteger<2 * limbs>;
  using Volume = WideInteger<3 * limbs>;
  using Time = WideInteger<2>;
  using AreaAtTime = WideInteger<2 * limbs + 4>;
  using VolumeAtTime = WideInteger<3 * limbs + 6>;
};
struct UnboundedNumbers {
  static constexpr int finest = std::numeric_limits<int>::max();
  using Length = UnboundedInteger;
  using Area = UnboundedInteger;
  using Volume = UnboundedInteger;
  using Time = UnboundedInteger;
  using AreaAtTime = UnboundedInteger;
  using VolumeAtTime = UnboundedInteger;
};

/// The open interval from low / 2^exponent to high / 2^exponent, or that one point when both are equal.
template <class Numbers>
struct TimeInterval {
  typename Numbers::Time low{}, high{};
  int exponent = 0;
  int gain = 1;  ///< see `refine`

  bool is_point() const { return low == high; }
};

/// A simple root of a cubic polynomial: the only one in the interval.
template <class Numbers>
struct StepRoot {
  TimeInterval<Numbers> interval;
  int sign_before = 0;                             ///< sign of the polynomial in the interval before the root
  Cubic<typename Numbers::VolumeAtTime> powers{};  ///< coefficients of 1, t, t², t³
  bool too_fine = false;  ///< the integers are too short to narrow the interval further
};

/// 8^exponent times the value at time / 2^exponent.
template <class Int, class Time>
Int value_at(const Cubic<Int>& powers, const Time& time, int exponent) {
  Int value = scaled(powers[3], time) + (powers[2] << exponent);
  value = scaled(value, time) + (powers[1] << 2 * exponent);
  return scaled(value, time) + (powers[0] << 3 * exponent);
}

/// Signs of the Bernstein coefficients of the polynomial over the interval. For a point, three times the sign
/// of its value.
template <class Numbers>
std::array<int, 3> signs_over(const TimeInterval<Numbers>& interval,
                              const Quadratic<typename Numbers::Area>& quadratic) {
  using Value = typename Numbers::AreaAtTime;
  const Quadratic<Value> p = powers(widened<Value>(quadratic));
  const int k = interval.exponent;
  const Value linear = p[1] << k, constant = p[0] << 2 * k;
  const Value low = scaled(p[2], interval.low), at_low = scaled(low + linear, interval.low) + constant;
  if (interval.is_point()) return {sign(at_low), sign(at_low), sign(at_low)};
  const Value high = scaled(p[2], interval.high), at_high = scaled(high + linear, interval.high) + constant;
  const Value between = scaled(low, interval.high), slope = scaled(linear, interval.low + interval.high);
  return {sign(at_low), sign(between + between + slope + constant + constant), sign(at_high)};
}

/// The sign that the polynomial has throughout the interval, or 0 when the coefficients do not prove one.
template <class Numbers>
int sign_over(const TimeInterval<Numbers>& interval, const Quadratic<typename Numbers::Area>& quadratic) {
  if (interval.is_point() && interval.exponent == 0) {
    return sign(quadratic[sign(interval.low) == 0 ? 0 : 2]);
  }
  const SignChanges changes = sign_changes(quadratic);
  if (changes.count == 0) return changes.first;
  const auto [low, between, high] = signs_over(interval, quadratic);
  if (low * between < 0 || between * high < 0 || low * high < 0) return 0;
  return low != 0 ? low : between != 0 ? between : high;
}

/// The common roots of some quadratic polynomials.
template <class Numbers>
class CommonRoots {
 public:
  using Area = typename Numbers::Area;

  void add(const Quadratic<Area>& q) {
    if (!exist_ || all_zero(q)) return;
    if (all_zero(first_)) {
      first_ = q;
    } else if (!unique_) {
      const Square xx = product(first_[0], q[1]) - product(first_[1], q[0]);
      const Square xy = product(first_[2], q[0]) - product(first_[0], q[2]);
      const Square yy = product(first_[1], q[2]) - product(first_[2], q[1]);
      squares_ = {yy, xy, xx};
      unique_ = !all_zero(squares_);
      exist_ = sign(product(xy, xy) - product(xx, yy)) == 0;
    } else {
      const auto value = product(squares_[0], q[0]) + product(squares_[1], q[1]) + product(squares_[2], q[2]);
      exist_ = sign(value) == 0;
    }
  }

  /// Whether all polynomials have a common root in the interval. True if all are 0.
  bool any_in(const TimeInterval<Numbers>& interval) const {
    if (!exist_ || all_zero(first_)) return exist_;
    return unique_ ? unique_root_in(interval) : root_of_first_in(interval);
  }

 private:
  using Square = decltype(product(Area(), Area()));

  bool unique_root_in(const TimeInterval<Numbers>& interval) const {
    const int side = sign(squares_[1]);
    if (side == 0 || sign(squares_[2]) != side) return false;
    const Square x = side < 0 ? Square(-squares_[2]) : squares_[2];
    const Square y = side < 0 ? Square(-squares_[1]) : squares_[1];
    using Product = decltype(product(x, interval.low));
    const Product whole(x + y), part = Product(x) << interval.exponent;
    return sign(part - scaled(whole, interval.low)) > 0 && sign(part - scaled(whole, interval.high)) < 0;
  }
  bool root_of_first_in(const TimeInterval<Numbers>& interval) const {
    const auto [low, between, high] = signs_over(interval, first_);
    if (low * high < 0) return true;
    if (low == 0 || high == 0) return (low + high) * between < 0;
    if (low * between >= 0) return false;
    const Square four = product(first_[0], first_[2]) << 2;
    return sign(product(first_[1], first_[1]) - four) >= 0;
  }

  bool exist_ = true, unique_ = false;
  Quadratic<Area> first_{};
  Quadratic<Square> squares_{};  ///< y², x y and x² of the unique root t = x / (x + y), up to a common factor
};

}  // namespace supple
