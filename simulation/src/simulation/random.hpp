#pragma once

#include <cstdint>

#include "supple/types.hpp"

namespace supple {

/// A pseudo-random number in [0, 1) that depends on all bits of `number`, for items that have a number and no
/// generator.
double random_unit(std::uint64_t number);

/// Random numbers with the same bits on every machine: the SplitMix64 generator by Steele, Lea and Flood
/// ("Fast splittable pseudorandom number generators", 2014).
class Random {
 public:
  /// Streams of one seed are independent of each other.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t next();
  /// Uniform in [0, 1): each multiple of 2^-53 is equally likely.
  double uniform();
  /// A unit vector; all directions are equally likely.
  Vec3d direction();

 private:
  std::uint64_t state_;
};

}  // namespace supple
