#include "simulation/random.hpp"

#include <cmath>

namespace supple {
namespace {

constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15u;

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Each multiple of 2^-53 in [0, 1) is equally likely.
double unit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace

double random_unit(std::uint64_t number) {
  return unit(mix(number * golden_ratio));
}

Random::Random(std::uint64_t seed, std::uint64_t stream)
    : state_(mix(mix(seed + golden_ratio) + stream * golden_ratio)) {}

std::uint64_t Random::next() {
  state_ += golden_ratio;
  return mix(state_);
}

double Random::uniform() {
  return unit(next());
}

/// Draws points in a cube until one is in the sphere, which needs no trigonometry.
Vec3d Random::direction() {
  for (;;) {
    const double x = 2 * uniform() - 1, y = 2 * uniform() - 1, z = 2 * uniform() - 1;
    const double squared = x * x + y * y + z * z;
    if (squared > 1 || squared < 0x1p-20) continue;
    return Vec3d{x, y, z} * (1 / std::sqrt(squared));
  }
}

}  // namespace supple
