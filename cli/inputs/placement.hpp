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

}  // namespace supple::cli
