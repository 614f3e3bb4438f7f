#pragma once

#include <cmath>

namespace supple {

/// A double and a bound of its error. A bound that overflows is infinite or NaN, and then no sign is known.
struct BoundedDouble {
  double value = 0, bound = 0;

  /// a - b of two doubles.
  static BoundedDouble difference(double a, double b) {
    const double value = a - b;
    return {value, 0x1p-53 * std::fabs(value)};
  }
  /// The result of one operation on doubles: covers its rounding, an underflow, and the roundings of `error`.
  static BoundedDouble rounded(double value, double error) {
    return {value, (error + 0x1p-53 * std::fabs(value)) * (1 + 0x1p-49) + 0x1p-1060};
  }
  friend BoundedDouble operator+(const BoundedDouble& a, const BoundedDouble& b) {
    return rounded(a.value + b.value, a.bound + b.bound);
  }
  friend BoundedDouble operator-(const BoundedDouble& a, const BoundedDouble& b) {
    return rounded(a.value - b.value, a.bound + b.bound);
  }
  friend BoundedDouble operator*(const BoundedDouble& a, const BoundedDouble& b) {
    return rounded(a.value * b.value,
                   std::fabs(a.value) * b.bound + a.bound * std::fabs(b.value) + a.bound * b.bound);
  }
};

/// What `sign_of` returns when the sign is not known.
constexpr int unknown_sign = 2;

inline int sign_of(const BoundedDouble& n) {
  return std::fabs(n.value) > n.bound ? (n.value > 0 ? 1 : -1) : unknown_sign;
}

}  // namespace supple
