#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace supple {

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

}  // namespace supple
