#pragma once

#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple {

/// The distance between two triangles and its direction from a to b, both rounded. Where rounding leaves no
/// distance, it is 0, and the direction is the one that separates them best.
struct TriangleGap {
  Vec3d axis;  ///< unit vector; zero for two triangles that are the same point
  double distance = 0;
};

/// For finite triangles that do not meet; in plain floating point.
TriangleGap triangle_gap(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
