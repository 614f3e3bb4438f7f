#pragma once

#include <cmath>

#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/wide_integer.hpp"

namespace supple {

/// The quotient of integers p ≥ 0 and q > 0 as a · 2^exponent, with 0.5 < a < 2.
struct Quotient {
  double a = 0;
  int exponent = 0;

  Quotient(const UnboundedInteger& p, const UnboundedInteger& q) {
    if (sign(p) == 0) return;
    const int bits_p = bit_length(p), bits_q = bit_length(q);
    a = approximate(p, -bits_p) / approximate(q, -bits_q);
    exponent = bits_p - bits_q;
  }
  double value() const { return std::ldexp(a, exponent); }
  /// Times 2^scale.
  double square_root(int scale) const {
    const int odd = exponent & 1;
    return std::ldexp(std::sqrt(odd != 0 ? 2 * a : a), (exponent - odd) / 2 + scale);
  }
};

}  // namespace supple
