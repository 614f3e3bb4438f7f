#pragma once

#include <array>
#include <cstddef>

#include "geometry/numbers/wide_integer.hpp"

namespace supple {

// Polynomials over the step. Coefficients c of degree d stand for the sum of c[i] t^i (1 - t)^(d-i), which is
// also a form in x = t and y = 1 - t. Coefficients of one sign prove that sign for 0 < t < 1. The number of
// roots there is the number of changes of sign, or less by an even number (Descartes' rule).

template <class Int>
using Quadratic = std::array<Int, 3>;
template <class Int>
using Cubic = std::array<Int, 4>;

template <class Int, std::size_t size>
bool all_zero(const std::array<Int, size>& polynomial) {
  for (const Int& coefficient : polynomial) {
    if (sign(coefficient) != 0) return false;
  }
  return true;
}

/// The sign of all coefficients, or 0 when they differ.
template <class Int, std::size_t size>
int strict_sign(const std::array<Int, size>& polynomial) {
  const int first = sign(polynomial[0]);
  for (std::size_t i = 1; i < size; ++i) {
    if (sign(polynomial[i]) != first) return 0;
  }
  return first;
}

struct SignChanges {
  int first = 0;  ///< sign of the first coefficient that is not 0: the polynomial's sign just after t = 0
  int count = 0;
};

template <class Int, std::size_t size>
SignChanges sign_changes(const std::array<Int, size>& polynomial) {
  SignChanges changes;
  int last = 0;
  for (const Int& coefficient : polynomial) {
    const int current = sign(coefficient);
    if (current == 0) continue;
    if (last == 0) changes.first = current;
    changes.count += current == -last;
    last = current;
  }
  return changes;
}

/// The same polynomial, one degree higher: times t + (1 - t).
template <class Int>
Quadratic<Int> raised(const std::array<Int, 2>& linear) {
  return {linear[0], linear[0] + linear[1], linear[1]};
}
template <class Int>
Cubic<Int> raised(const Quadratic<Int>& quadratic) {
  return {quadratic[0], quadratic[0] + quadratic[1], quadratic[1] + quadratic[2], quadratic[2]};
}

template <class Result, class Int, std::size_t size>
std::array<Result, size> widened(const std::array<Int, size>& polynomial) {
  std::array<Result, size> result;
  for (std::size_t i = 0; i < size; ++i) result[i] = Result(polynomial[i]);
  return result;
}

/// Coefficients of 1, t, t², …
template <class Int>
Quadratic<Int> powers(const Quadratic<Int>& c) {
  return {c[0], c[1] - c[0] - c[0], c[0] - c[1] + c[2]};
}
template <class Int>
Cubic<Int> powers(const Cubic<Int>& c) {
  const Int tripled = c[0] + c[0] + c[0];
  return {c[0], c[1] - tripled, tripled - c[1] - c[1] + c[2], c[3] - c[2] + c[1] - c[0]};
}

/// 8 times the polynomial over the first half of the step, mapped to [0, 1]: y becomes x + 2 y.
template <class Int>
Cubic<Int> first_half(const Cubic<Int>& c) {
  const Int sum = c[0] + c[1], tripled = sum + c[0] + c[0];
  return {c[0] << 3, tripled << 2, (tripled + c[1] + c[2]) << 1, sum + c[2] + c[3]};
}
template <class Int>
Cubic<Int> second_half(const Cubic<Int>& c) {
  const Cubic<Int> half = first_half(Cubic<Int>{c[3], c[2], c[1], c[0]});
  return {half[3], half[2], half[1], half[0]};
}

}  // namespace supple
