#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "geometry/numbers/integer_points.hpp"

namespace supple {

__extension__ typedef unsigned __int128 UnsignedInt128;

/// Integer of limbs · 64 bits in two's complement. The size is known at compile time, so sums and products
/// compile to straight sequences of machine words, about ten times as fast as `FixedInteger`. Values that are
/// too large wrap silently; callers prove that they do not occur.
template <std::size_t limbs>
struct WideInteger {
  std::array<std::uint64_t, limbs> words{};  ///< the least significant first

  WideInteger() = default;
  explicit WideInteger(std::uint64_t value) { words[0] = value; }
  /// Keeps the value, or its lowest bits where it does not fit.
  template <std::size_t other>
  explicit WideInteger(const WideInteger<other>& value) {
    const std::uint64_t fill = value.negative() ? ~std::uint64_t{0} : 0;
    for (std::size_t i = 0; i < limbs; ++i) words[i] = i < other ? value.words[i] : fill;
  }

  bool negative() const { return (words[limbs - 1] >> 63) != 0; }

  WideInteger& operator+=(const WideInteger& other) {
    UnsignedInt128 carry = 0;
    for (std::size_t i = 0; i < limbs; ++i) {
      carry += UnsignedInt128{words[i]} + other.words[i];
      words[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return *this;
  }
  WideInteger& operator-=(const WideInteger& other) {
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < limbs; ++i) {
      const UnsignedInt128 rest = UnsignedInt128{words[i]} - other.words[i] - borrow;
      words[i] = static_cast<std::uint64_t>(rest);
      borrow = static_cast<std::uint64_t>(rest >> 64) & 1;
    }
    return *this;
  }
  WideInteger& operator<<=(int count) {
    const std::size_t whole = static_cast<std::size_t>(count) / 64;
    const int rest = count % 64;
    for (std::size_t i = limbs; i-- > 0;) {
      const std::uint64_t high = i >= whole ? words[i - whole] : 0;
      const std::uint64_t low = i >= whole + 1 ? words[i - whole - 1] : 0;
      words[i] = rest == 0 ? high : (high << rest) | (low >> (64 - rest));
    }
    return *this;
  }
  /// For values ≥ 0.
  WideInteger& operator>>=(int count) {
    const std::size_t whole = static_cast<std::size_t>(count) / 64;
    const int rest = count % 64;
    for (std::size_t i = 0; i < limbs; ++i) {
      const std::uint64_t low = i + whole < limbs ? words[i + whole] : 0;
      const std::uint64_t high = i + whole + 1 < limbs ? words[i + whole + 1] : 0;
      words[i] = rest == 0 ? low : (low >> rest) | (high << (64 - rest));
    }
    return *this;
  }

  friend WideInteger operator+(WideInteger a, const WideInteger& b) { return a += b; }
  friend WideInteger operator-(WideInteger a, const WideInteger& b) { return a -= b; }
  friend WideInteger operator-(const WideInteger& a) { return WideInteger() - a; }
  friend WideInteger operator<<(WideInteger a, int count) { return a <<= count; }
  friend WideInteger operator>>(WideInteger a, int count) { return a >>= count; }
  friend bool operator==(const WideInteger&, const WideInteger&) = default;
};

template <std::size_t limbs>
int sign(const WideInteger<limbs>& value) {
  if (value.negative()) return -1;
  std::uint64_t any = 0;
  for (const std::uint64_t word : value.words) any |= word;
  return any != 0;
}

/// The lowest `result` limbs of the product of two unsigned numbers.
template <std::size_t result, std::size_t m, std::size_t n>
WideInteger<result> unsigned_product(const WideInteger<m>& a, const WideInteger<n>& b) {
  WideInteger<result> product;
  for (std::size_t i = 0; i < m; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < n && i + j < result; ++j) {
      const UnsignedInt128 sum = UnsignedInt128{a.words[i]} * b.words[j] + product.words[i + j] + carry;
      product.words[i + j] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    if (i + n < result) product.words[i + n] = carry;
  }
  return product;
}

/// a · b. The result always fits.
template <std::size_t m, std::size_t n>
WideInteger<m + n> product(const WideInteger<m>& a, const WideInteger<n>& b) {
  WideInteger<m + n> result = unsigned_product<m + n>(a, b);
  // The product treated a negative number as larger by 2^(64 limbs). Subtract this excess.
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; a.negative() && i < n; ++i) {
    const UnsignedInt128 rest = UnsignedInt128{result.words[m + i]} - b.words[i] - borrow;
    result.words[m + i] = static_cast<std::uint64_t>(rest);
    borrow = static_cast<std::uint64_t>(rest >> 64) & 1;
  }
  borrow = 0;
  for (std::size_t i = 0; b.negative() && i < m; ++i) {
    const UnsignedInt128 rest = UnsignedInt128{result.words[n + i]} - a.words[i] - borrow;
    result.words[n + i] = static_cast<std::uint64_t>(rest);
    borrow = static_cast<std::uint64_t>(rest >> 64) & 1;
  }
  return result;
}
inline WideInteger<2> product(const WideInteger<1>& a, const WideInteger<1>& b) {
  const Int128 value = Int128{static_cast<std::int64_t>(a.words[0])} * static_cast<std::int64_t>(b.words[0]);
  WideInteger<2> result;
  result.words = {static_cast<std::uint64_t>(value), static_cast<std::uint64_t>(value >> 64)};
  return result;
}
inline UnboundedInteger product(const UnboundedInteger& a, const UnboundedInteger& b) {
  return a * b;
}

/// a · factor, where factor ≥ 0 and the product fits the type of a.
template <std::size_t m, std::size_t n>
WideInteger<m> scaled(const WideInteger<m>& a, const WideInteger<n>& factor) {
  return unsigned_product<m>(a, factor);
}
inline UnboundedInteger scaled(const UnboundedInteger& a, const UnboundedInteger& factor) {
  return a * factor;
}

/// The number of bits of a value ≥ 0; 0 for 0.
template <std::size_t limbs>
int bit_length(const WideInteger<limbs>& value) {
  for (std::size_t i = limbs; i-- > 0;) {
    if (value.words[i] != 0) return static_cast<int>(64 * i) + 64 - std::countl_zero(value.words[i]);
  }
  return 0;
}
inline int bit_length(const UnboundedInteger& value) {
  return value.is_zero() ? 0 : static_cast<int>(msb(value)) + 1;
}

template <std::size_t limbs>
std::uint64_t lowest_word(const WideInteger<limbs>& value) {
  return value.words[0];
}
inline std::uint64_t lowest_word(const UnboundedInteger& value) {
  return static_cast<std::uint64_t>(value & ~std::uint64_t{0});
}

/// value · 2^exponent with a relative error below 2^-50, unless it overflows or underflows.
template <class Int>
double approximate(const Int& value, int exponent) {
  const bool negative = sign(value) < 0;
  const Int magnitude = negative ? Int(-value) : value;
  const int excess = std::max(0, bit_length(magnitude) - 64);
  const double top =
      std::ldexp(static_cast<double>(lowest_word(Int(magnitude >> excess))), excess + exponent);
  return negative ? -top : top;
}

/// The largest double ≤ numerator / 2^exponent or, when `up`, the smallest double ≥ it. The numerator is ≥ 0.
template <class Int>
double round_time(const Int& numerator, int exponent, bool up) {
  const int excess = std::max({bit_length(numerator) - 53, exponent - 1074, 0});
  const Int kept = numerator >> excess;
  const bool inexact = (kept << excess) != numerator;
  return std::ldexp(static_cast<double>(lowest_word(kept)) + (up && inexact ? 1 : 0), excess - exponent);
}

}  // namespace supple
