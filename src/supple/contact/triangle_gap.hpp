#pragma once

#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple {

/// How far apart two triangles are, and the direction from a to b in which they are: rounded.
struct TriangleGap {
  Vec3d axis;  ///< unit vector; zero where rounding leaves no distance
  double distance = 0;
};

/// Of finite triangles, in plain floating point. Where they meet it is of no use.
TriangleGap triangle_gap(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
