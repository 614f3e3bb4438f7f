#pragma once

#include <array>

#include "supple/types.hpp"

namespace supple {

/// The points c + t0 h0 a0 + t1 h1 a1 + t2 h2 a2 with |t| <= 1. The axes are of unit length and at right
/// angles, except for their rounding to float.
struct OrientedBox {
  Vec3f center{};
  std::array<Vec3f, 3> axes{Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}};
  Vec3f half_lengths{};
};

}  // namespace supple
