#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple::cli {

/// The rows of a matrix.
using Rotation = std::array<Vec3d, 3>;

/// The placement of an object in a scene. It applies to each point in double, without fused multiply-add, in
/// this order: scale; rotation about the fixed x axis, then the y axis, then the z axis, counter-clockwise
/// seen from the tip of the axis, with each row of the matrix Rz Ry Rx summed from left to right; `turn` in
/// the same way; `translate`. Multiples of 90 degrees are exact.
struct Placement {
  double scale = 1;
  Vec3d rotate_xyz_degrees;
  std::optional<Rotation> turn{};
  Vec3d translate;

  /// Whether it mirrors. Triangles then turn over, so that they keep their outer sides.
  bool mirrors() const { return scale < 0; }
};

void place(std::span<Vec3d> positions, const Placement& placement);

/// Exchanges the last two corners of each triangle.
void turn_over(std::span<Triangle> triangles);

/// A random rotation for a seed and a number, with uniform distribution (Shoemake, Uniform Random Rotations,
/// 1992).
Rotation random_rotation(std::uint64_t seed, std::uint64_t number);

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
