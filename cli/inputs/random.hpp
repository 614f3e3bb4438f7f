#pragma once

#include <cstdint>

namespace supple::cli {

/// 64 bits that depend on all bits of `number` (the SplitMix64 generator by Steele, Lea and Flood, 2014).
constexpr std::uint64_t scrambled(std::uint64_t number) {
  std::uint64_t z = number * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// A number in [0, 1) that depends on all bits of `number`.
constexpr double random_unit(std::uint64_t number) {
  return static_cast<double>(scrambled(number) >> 11) / 9007199254740992.0;
}

}  // namespace supple::cli
