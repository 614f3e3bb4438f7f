#pragma once

#include "supple/triangle_intersection.hpp"

namespace supple {

/// The public function of this name. Sets `used_exact` when it needs integers, and leaves it unchanged
/// otherwise.
bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b, bool& used_exact);

/// The public function of this name, except that the normal is zero.
TriangleIntersection intersect_triangles_without_normal(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
