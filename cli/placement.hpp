#pragma once

#include "supple/types.hpp"

#include <vector>

namespace supple::cli {

/// Where an object of a scene stands. Applied to each point in double, without fused multiply-add: each
/// coordinate times `scale`; then the rotation about the fixed x, then y, then z axis, counter-clockwise seen
/// from the axis' tip, each row of the matrix Rz Ry Rx summed from left to right; then `translate` is added.
/// Multiples of 90 degrees are exact.
struct Placement {
  double scale = 1;
  Vec3d rotate_xyz_degrees;
  Vec3d translate;
};

void place(std::vector<Vec3d>& positions, const Placement& placement);

}  // namespace supple::cli
