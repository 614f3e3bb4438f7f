#pragma once

#include <algorithm>

#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/wide_integer.hpp"

namespace supple {

/// Where the line through two values of different sign, at 0 and at 2^gain, is zero: rounded down. When one
/// value is 0, this is its end.
inline UnboundedInteger crossing_of_chord(UnboundedInteger first, UnboundedInteger last, int gain) {
  first = abs(first);
  last = abs(last);
  // A few more bits than the result suffice.
  const int excess = std::max(0, bit_length(UnboundedInteger(first + last)) - gain - 64);
  first >>= excess;
  last >>= excess;
  return (first << gain) / (first + last);
}

/// Quadratic interval refinement (Abbott, Quadratic interval refinement for real roots, 2006): the interval
/// becomes one of its 2^gain parts when a chord finds the part with the root. The gain then doubles, so the
/// number of steps grows with the logarithm of the precision. Otherwise the gain halves. With a gain of 1,
/// this is bisection.
///
/// The interval is open, from low / 2^exponent to high / 2^exponent, with a root that is the only one and
/// simple. Before it the polynomial has the sign `sign_before`. `value_at(n, k)` is the value at n / 2^k,
/// times any positive number that depends on k. Where the root is found exactly, low and high are both it.
template <class Interval, class ValueAt>
void refine(Interval& interval, int sign_before, const ValueAt& value_at) {
  const int gain = interval.gain;
  const UnboundedInteger width = interval.high - interval.low;
  UnboundedInteger part = 1;
  if (gain > 1) {
    const auto first = value_at(interval.low, interval.exponent);
    const auto last = value_at(interval.high, interval.exponent);
    // An end may be another root. Then this root may be close to it.
    if (sign(first) != 0 || sign(last) != 0) part = crossing_of_chord(first, last, gain);
  }
  const int exponent = interval.exponent + gain;
  const UnboundedInteger low = interval.low << gain, high = interval.high << gain;
  const auto position = [&](const UnboundedInteger& n) { return UnboundedInteger(low + n * width); };
  const auto side_at = [&](const UnboundedInteger& x) {
    if (x == low) return sign_before;
    return x == high ? -sign_before : sign(value_at(x, exponent));
  };
  const UnboundedInteger x = position(part);
  const int side = side_at(x);
  if (side == 0) {
    interval = {x, x, exponent};
    return;
  }
  const bool is_before = side == sign_before;
  const UnboundedInteger y = is_before ? UnboundedInteger(x + width) : UnboundedInteger(x - width);
  const int other = side_at(y);
  if (other == 0) {
    interval = {y, y, exponent};
  } else if (other == side) {
    interval.gain = gain / 2;
  } else {
    interval = {is_before ? x : y, is_before ? y : x, exponent, 2 * gain};
  }
}

}  // namespace supple
