#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "supple/types.hpp"

namespace supple::cli {

/// A matrix by its rows.
using Rotation = std::array<Vec3d, 3>;

/// Where an object of a scene stands. Applied to each point in double, without fused multiply-add: each
/// coordinate times `scale`; then the rotation about the fixed x, then y, then z axis, counter-clockwise seen
/// from the axis' tip, each row of the matrix Rz Ry Rx summed from left to right; then `turn` in the same
/// way; then `translate` is added. Multiples of 90 degrees are exact.
struct Placement {
  double scale = 1;
  Vec3d rotate_xyz_degrees;
  std::optional<Rotation> turn{};
  Vec3d translate;
};

void place(std::vector<Vec3d>& positions, const Placement& placement);

/// One of all rotations, each as likely as any other, for each seed and number (Shoemake, Uniform Random
/// Rotations, 1992).
Rotation random_rotation(std::uint64_t seed, std::uint64_t number);

}  // namespace supple::cli
