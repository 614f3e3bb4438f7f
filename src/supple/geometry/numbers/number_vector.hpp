#pragma once

#include <array>

namespace supple {

/// A vector of any kind of numbers: doubles with bounds, pairs of doubles, or integers.
template <class Number>
using NumberVector = std::array<Number, 3>;

template <class Number>
NumberVector<Number> minus(const NumberVector<Number>& a, const NumberVector<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
Number dot(const NumberVector<Number>& a, const NumberVector<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
NumberVector<Number> cross(const NumberVector<Number>& a, const NumberVector<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace supple
