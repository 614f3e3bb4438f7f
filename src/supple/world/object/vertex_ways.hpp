#pragma once

#include "supple/types.hpp"

namespace supple {

/// How far the vertices of an object move, without those that are not finite.
struct VertexWays {
  Vec3d mean;
  double farthest_from_mean = 0, longest = 0;
  double largest_coordinate = 0;  ///< at the start
};

}  // namespace supple
