#pragma once

#include "supple/triangle_intersection.hpp"

namespace supple {

/// `TriangleIntersection::normal` of two closed triangles that intersect. Finite coordinates of any size.
Vec3d separating_normal(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
