#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "contact/impact/step_root.hpp"
#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/root_refinement.hpp"
#include "supple/continuous.hpp"

namespace supple {

template <class Numbers>
struct StepRoots {
  std::array<StepRoot<Numbers>, 3> roots{};
  std::size_t count = 0;
  bool incomplete = false;  ///< the integers are too short to separate all roots

  void add(const Cubic<typename Numbers::VolumeAtTime>& powers, int sign_before,
           const TimeInterval<Numbers>& interval) {
    roots[count++] = {interval, sign_before, powers, false};
  }
};

/// The polynomial's Hessian covariant. It is a square exactly when the polynomial has a repeated root.
template <class Int>
auto hessian(const Cubic<Int>& c) {
  const auto c02 = product(c[0], c[2]), c03 = product(c[0], c[3]), c13 = product(c[1], c[3]);
  using Square = decltype(product(c[0], c[0]));
  return Quadratic<Square>{product(c[1], c[1]) - c02 - (c02 << 1), product(c[1], c[2]) - c03 - (c03 << 3),
                           product(c[2], c[2]) - c13 - (c13 << 1)};
}
template <class Int>
bool is_square(const Quadratic<Int>& q) {
  return sign(product(q[1], q[1]) - (product(q[0], q[2]) << 2)) == 0;
}

/// A polynomial with the same roots, all simple. `polynomial` has a repeated root and changes its sign.
inline Cubic<UnboundedInteger> without_repetition(const Cubic<UnboundedInteger>& c) {
  const Quadratic<UnboundedInteger> square = hessian(c);
  if (all_zero(square)) return raised(raised(std::array<UnboundedInteger, 2>{3 * c[0], c[1]}));
  // The root that is double is that of p x + q y, by which p³ c divides. p is not zero: a double root at
  // y = 0 leaves no changes of sign.
  const UnboundedInteger p = 2 * square[2], q = square[1], rest = p * c[2] - q * c[3];
  return raised(Quadratic<UnboundedInteger>{p * p * c[1] - q * rest, p * rest, p * p * c[3]});
}

/// All roots in [0, 1] of a polynomial that is not 0, by bisection until Descartes' rule separates them.
template <class Numbers>
StepRoots<Numbers> find_roots(const Cubic<typename Numbers::Volume>& polynomial) {
  using Value = typename Numbers::VolumeAtTime;
  using Time = typename Numbers::Time;
  StepRoots<Numbers> found;
  Cubic<Value> piece = widened<Value>(polynomial);
  if (sign_changes(polynomial).count > 1 && is_square(hessian(polynomial))) {
    if constexpr (std::is_same_v<Numbers, UnboundedNumbers>) {
      piece = without_repetition(polynomial);
    } else {
      found.incomplete = true;
      return found;
    }
  }
  const Cubic<Value> whole = powers(piece);
  const Time zero(std::uint64_t{0}), one(std::uint64_t{1});
  if (sign(piece[0]) == 0) found.add(whole, 0, {zero, zero, 0});
  if (sign(piece[3]) == 0) found.add(whole, 0, {one, one, 0});

  Time index = zero;
  for (int exponent = 0;; ++exponent) {
    const SignChanges changes = sign_changes(piece);
    if (changes.count == 1) found.add(whole, changes.first, {index, index + one, exponent});
    if (changes.count <= 1) return found;
    if (exponent == Numbers::finest) {
      found.incomplete = true;
      return found;
    }
    const Cubic<Value> left = first_half(piece), right = second_half(piece);
    const Time before = index << 1, middle = before + one;
    if (sign(right[0]) == 0) found.add(whole, 0, {middle, middle, exponent + 1});
    // The two halves together have at most as many changes of sign as the whole.
    const SignChanges left_changes = sign_changes(left), right_changes = sign_changes(right);
    const bool go_left = left_changes.count > 1;
    if (go_left && right_changes.count == 1) {
      found.add(whole, right_changes.first, {middle, middle + one, exponent + 1});
    }
    if (!go_left && left_changes.count == 1) {
      found.add(whole, left_changes.first, {before, middle, exponent + 1});
    }
    piece = go_left ? left : right;
    index = go_left ? before : middle;
  }
}

/// Halves the interval, or sets it to the middle when that is the root. Integers of any length halve it
/// several times. Returns false when the interval is a point already, or when the integers are too short.
template <class Numbers>
bool narrow(StepRoot<Numbers>& root) {
  TimeInterval<Numbers>& interval = root.interval;
  if (interval.is_point() || root.too_fine) return false;
  if constexpr (std::is_same_v<Numbers, UnboundedNumbers>) {
    refine(interval, root.sign_before,
           [&](const UnboundedInteger& time, int exponent) { return value_at(root.powers, time, exponent); });
  } else {
    root.too_fine = interval.exponent == Numbers::finest;
    if (root.too_fine) return false;
    const typename Numbers::Time middle = interval.low + interval.high;
    interval = {interval.low << 1, interval.high << 1, interval.exponent + 1};
    const int side = sign(value_at(root.powers, middle, interval.exponent));
    if (side != -root.sign_before) interval.low = middle;
    if (side != root.sign_before) interval.high = middle;
  }
  return true;
}

/// Writes `time`, 0 < time < 1, as numerator / 2^exponent with the interval's exponent, which grows if
/// needed. Returns false when the integers are too short.
template <class Numbers>
bool to_numerator(double time, StepRoot<Numbers>& root, typename Numbers::Time& numerator) {
  const Dyadic dyadic(time);
  const int zeros = std::countr_zero(dyadic.mantissa), exponent = -(dyadic.exponent + zeros);
  root.too_fine = exponent > Numbers::finest;
  if (root.too_fine) return false;
  TimeInterval<Numbers>& interval = root.interval;
  if (const int finer = exponent - interval.exponent; finer > 0) {
    interval = {interval.low << finer, interval.high << finer, exponent};
  }
  numerator = typename Numbers::Time(dyadic.mantissa >> zeros) << (interval.exponent - exponent);
  return true;
}

/// The polynomial in floating point, to guess where to evaluate exactly.
struct RoundedCubic {
  std::array<double, 4> powers;
  int exponent = 0;  ///< values are 2^exponent times those of the polynomial

  template <class Int>
  explicit RoundedCubic(const Cubic<Int>& exact) {
    for (const Int& power : exact) {
      exponent = std::min(exponent, -bit_length(sign(power) < 0 ? Int(-power) : power));
    }
    for (std::size_t i = 0; i < 4; ++i) powers[i] = approximate(exact[i], exponent);
  }
  double value(double t) const { return ((powers[3] * t + powers[2]) * t + powers[1]) * t + powers[0]; }
  double slope(double t) const { return (3 * powers[3] * t + 2 * powers[2]) * t + powers[1]; }

  double guess(double low, double high, int sign_before) const {
    double t = low + (high - low) / 2;
    for (int i = 0; i < 20; ++i) {
      const double here = value(t);
      (here * sign_before > 0 ? low : high) = t;
      double next = t - here / slope(t);
      if (!(next > low && next < high)) next = low + (high - low) / 2;
      if (std::fabs(next - t) <= 0x1p-53 * t) return next;
      t = next;
    }
    return t;
  }
};

/// The middle of two doubles in the order of doubles: bisection then reaches all magnitudes quickly.
inline double middle_double(double low, double high) {
  const auto first = std::bit_cast<std::uint64_t>(low), last = std::bit_cast<std::uint64_t>(high);
  return std::bit_cast<double>(first + (last - first) / 2);
}

/// The doubles next to the root. Narrows the interval to at most these.
template <class Numbers>
TimeBracket neighbouring_doubles(StepRoot<Numbers>& root) {
  TimeInterval<Numbers>& interval = root.interval;
  double low = round_time(interval.low, interval.exponent, false);
  double high = round_time(interval.high, interval.exponent, true);
  const auto next_above_low = [&] { return std::bit_cast<double>(std::bit_cast<std::uint64_t>(low) + 1); };
  if (low == high || next_above_low() == high) return {low, high};

  const RoundedCubic rounded(root.powers);
  double t = rounded.guess(low, high, root.sign_before);
  for (int step = 1; next_above_low() < high; ++step) {
    // Newton steps from exact values nearly always end at once. The bisection guarantees that the loop ends.
    if (step % 4 == 0 || !(t > low && t < high))
      t = step < 64 ? low + (high - low) / 2 : middle_double(low, high);
    typename Numbers::Time numerator;
    if (!to_numerator(t, root, numerator)) return {low, high};
    const auto value = value_at(root.powers, numerator, interval.exponent);
    const int side = sign(value);
    if (side != -root.sign_before) interval.low = numerator, low = t;
    if (side != root.sign_before) interval.high = numerator, high = t;
    if (side == 0) break;
    const double exact_value = approximate(value, rounded.exponent - 3 * interval.exponent);
    t -= exact_value / rounded.slope(t);
    if (t <= low) t = next_above_low();
    if (t >= high) t = std::bit_cast<double>(std::bit_cast<std::uint64_t>(high) - 1);
  }
  return {low, high};
}

}  // namespace supple
