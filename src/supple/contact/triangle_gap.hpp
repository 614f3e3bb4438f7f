#pragma once

#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple {

/// How far apart two triangles are, and the direction from a to b in which they are: rounded. Where rounding
/// leaves no distance, it is 0 and the direction the one that separates them best.
struct TriangleGap {
  Vec3d axis;  ///< unit vector; zero of two triangles that are one and the same point
  double distance = 0;
};

/// Of finite triangles, in plain floating point. Where they meet it is of no use.
TriangleGap triangle_gap(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
