#pragma once

#include <bit>
#include <cstdint>

namespace supple {

/// Unsigned integers in the order of the floats they come from; -0 goes before +0.
inline std::uint32_t float_order(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  return bits ^ ((bits >> 31) != 0 ? 0xffffffffu : 0x80000000u);
}

}  // namespace supple
