#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "supple/types.hpp"

namespace supple {

// Doubles are integers times powers of two. Multiplying each axis by its own power of two makes all
// coordinates of some points integers. It changes neither the sign of a determinant of their differences nor
// the ratio of two such determinants.

__extension__ typedef __int128 Int128;

/// high · 2^64 + low.
struct Int192 {
  Int128 high;
  std::uint64_t low;
};

using FixedInteger = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 512, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;
using UnboundedInteger =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

/// value = mantissa · 2^exponent with |mantissa| < 2^53.
struct Dyadic {
  std::uint64_t mantissa;
  int exponent;
  bool negative;

  explicit Dyadic(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const int biased = static_cast<int>((bits >> 52) & 0x7ff);
    mantissa = (bits & 0xfffffffffffff) | (biased == 0 ? 0 : std::uint64_t{1} << 52);
    exponent = (biased == 0 ? 1 : biased) - 1075;
    negative = (bits >> 63) != 0;
  }
};

/// The bits that finite numbers occupy: all are multiples of 2^bottom and below 2^top.
struct BitExtent {
  int bottom = 2000, top = -2000;  ///< of no number, or of 0

  void include(double value) {
    const Dyadic dyadic(value);
    if (dyadic.mantissa == 0) return;
    bottom = std::min(bottom, dyadic.exponent + std::countr_zero(dyadic.mantissa));
    top = std::max(top, dyadic.exponent + 64 - std::countl_zero(dyadic.mantissa));
  }
  int bits() const { return std::max(top - bottom, 0); }
};

/// The bits that numbers of one axis occupy: all are multiples of 2^lowest and below 2^(lowest + width).
struct BitRange {
  int lowest = 0, width = 0;

  template <std::size_t count>
  explicit BitRange(const std::array<double, count>& values) {
    BitExtent extent;
    for (const double value : values) extent.include(value);
    if (extent.bits() > 0) lowest = extent.bottom, width = extent.bits();
  }
};

template <class Int>
using Vector3 = std::array<Int, 3>;
template <class Int>
using Vector2 = std::array<Int, 2>;

template <class Int>
Int determinant(const Vector2<Int>& u, const Vector2<Int>& v) {
  return u[0] * v[1] - u[1] * v[0];
}
template <class Int>
Int determinant(const Vector3<Int>& u, const Vector3<Int>& v, const Vector3<Int>& w) {
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
         (u[0] * v[1] - u[1] * v[0]) * w[2];
}

/// The entries must be below 2^61.
inline Int128 determinant(const Vector2<std::int64_t>& u, const Vector2<std::int64_t>& v) {
  return Int128{u[0]} * v[1] - Int128{u[1]} * v[0];
}
/// The entries must be below 2^61. Then a minor is below 2^123, its lower half times an entry is below 2^125,
/// and the sum of three such products is below 2^127.
inline Int192 determinant(const Vector3<std::int64_t>& u, const Vector3<std::int64_t>& v,
                          const Vector3<std::int64_t>& w) {
  Int128 high = 0, low = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const Int128 minor = Int128{u[j]} * v[k] - Int128{u[k]} * v[j];
    high += (minor >> 64) * w[i];
    low += Int128{static_cast<std::uint64_t>(minor)} * w[i];
  }
  return {high + (low >> 64), static_cast<std::uint64_t>(low)};
}

inline int sign(Int128 value) {
  return (value > 0) - (value < 0);
}
inline int sign(const Int192& value) {
  return value.high != 0 ? sign(value.high) : value.low != 0;
}
inline int sign(const FixedInteger& value) {
  return value.sign();
}
inline int sign(const UnboundedInteger& value) {
  return value.sign();
}

inline double magnitude(Int128 value) {
  return static_cast<double>(value < 0 ? -value : value);
}
inline double magnitude(const Int192& value) {
  if (value.high >= 0) return static_cast<double>(value.high) * 0x1p64 + static_cast<double>(value.low);
  const std::uint64_t low = 0 - value.low;
  const Int128 high = -value.high - (low != 0);
  return static_cast<double>(high) * 0x1p64 + static_cast<double>(low);
}

/// |p| and |q| times one common factor, each with a relative error below 2^-51 or an error below 2^-800 of
/// the larger one. p and q are determinants of the same points.
template <class Int>
std::pair<double, double> relative_magnitudes(const Int& p, const Int& q) {
  if constexpr (requires { magnitude(p); }) {
    return {magnitude(p), magnitude(q)};
  } else {
    Int first = abs(p), second = abs(q);
    const Int& larger = first < second ? second : first;
    const unsigned top = larger == 0 ? 0 : static_cast<unsigned>(msb(larger));
    if (const unsigned excess = top > 900 ? top - 900 : 0) {
      first >>= excess;
      second >>= excess;
    }
    return {first.template convert_to<double>(), second.template convert_to<double>()};
  }
}

/// value · 2^-lowest.
template <class Int>
Int to_integer(double value, int lowest) {
  const Dyadic dyadic(value);
  if (dyadic.mantissa == 0) return Int(0);
  const int zeros = std::countr_zero(dyadic.mantissa);
  Int result(dyadic.mantissa >> zeros);
  result <<= dyadic.exponent + zeros - lowest;
  return dyadic.negative ? Int(-result) : result;
}

/// Calls `compute(integers)` with `integers[point][i]`, the coordinates of finite points along `axes[i]`, for
/// two or three axes. The integers have the smallest type in which differences of the points and their
/// determinants fit. A determinant of differences takes at most the sum of the axes' widths + 3 bits for two
/// axes, + 6 bits for three.
template <std::size_t count, std::size_t dimension, class Compute>
auto with_integers(const std::array<Vec3d, count>& points, const std::array<int, dimension>& axes,
                   Compute compute) {
  std::array<int, dimension> lowest;
  int widest = 0, total = 0;
  for (std::size_t i = 0; i < dimension; ++i) {
    std::array<double, count> coordinates;
    for (std::size_t p = 0; p < count; ++p) coordinates[p] = points[p][axes[i]];
    const BitRange range(coordinates);
    lowest[i] = range.lowest;
    widest = std::max(widest, range.width);
    total += range.width;
  }
  const auto integers = [&]<class Int>(Int) {
    std::array<std::array<Int, dimension>, count> result;
    for (std::size_t p = 0; p < count; ++p) {
      for (std::size_t i = 0; i < dimension; ++i) {
        result[p][i] = to_integer<Int>(points[p][axes[i]], lowest[i]);
      }
    }
    return result;
  };
  if (widest <= 60) return compute(integers(std::int64_t{}));
  if (total <= 506) return compute(integers(FixedInteger{}));
  return compute(integers(UnboundedInteger{}));
}

template <class Int, std::size_t axes>
std::array<Int, axes> difference(const std::array<Int, axes>& a, const std::array<Int, axes>& b) {
  std::array<Int, axes> result;
  for (std::size_t axis = 0; axis < axes; ++axis) result[axis] = a[axis] - b[axis];
  return result;
}

}  // namespace supple
