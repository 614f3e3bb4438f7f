#pragma once

#include <cmath>
#include <cstdint>

#include "supple/trigonometry.hpp"
#include "supple/types.hpp"

namespace supple::benchmarks {

/// Random numbers with the same bits on every machine: the SplitMix64 generator of Steele, Lea and Flood
/// (2014), and distributions that use only arithmetic, square roots and the library's own sine.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  Vec3d point_in_cube(double side) {
    const double x = uniform() * side, y = uniform() * side;
    return {x, y, uniform() * side};
  }
  /// A unit vector, uniformly distributed.
  Vec3d direction() {
    for (;;) {
      const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
      const double squared = x * x + y * y + z * z;
      if (squared <= 1 && squared >= 0x1p-20) return Vec3d{x, y, z} * (1 / std::sqrt(squared));
    }
  }
  /// Normal distribution with mean 0 and variance 1 (Box and Muller).
  double gaussian() {
    const double radius = std::sqrt(-2 * logarithm(1 - uniform()));
    return radius * sin_turns(uniform());
  }
  /// Pareto distribution with alpha 2, bounded to [low, high]: density ~ x^-3.
  double bounded_pareto(double low, double high) {
    const double ratio = low / high;
    return low / std::sqrt(1 - uniform() * (1 - ratio * ratio));
  }

 private:
  /// For x in (0, 1], by the series of the inverse hyperbolic tangent, because standard libraries round
  /// differently.
  static double logarithm(double x) {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    const double ratio = (mantissa - 1) / (mantissa + 1), square = ratio * ratio;
    double sum = 0;
    for (int power = 33; power >= 1; power -= 2) sum = sum * square + 1.0 / power;
    return exponent * 0.69314718055994530942 + 2 * ratio * sum;
  }

  std::uint64_t state_;
};

/// Newton's iteration, for x ≥ 1; the same bits everywhere.
inline double cube_root(double x) {
  double root = x;
  for (int i = 0; i < 80; ++i) root -= (root - x / (root * root)) / 3;
  return root;
}

}  // namespace supple::benchmarks
