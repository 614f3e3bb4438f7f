#pragma once

#include <cstdint>

#include "supple/types.hpp"

namespace supple {

/// A number of [0, 1) that depends on all bits of `number`: for what has a number of its own and no
/// generator.
double random_unit(std::uint64_t number);

/// Random numbers, the same bits on every machine: the SplitMix64 generator by Steele, Lea and Flood ("Fast
/// splittable pseudorandom number generators", 2014).
class Random {
 public:
  /// Streams of one seed have nothing to do with one another.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t next();
  /// Of [0, 1), all multiples of 2^-53 alike.
  double uniform();
  /// Of length 1, all directions alike.
  Vec3d direction();

 private:
  std::uint64_t state_;
};

}  // namespace supple
