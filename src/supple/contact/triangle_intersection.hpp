#pragma once

#include "supple/triangle_intersection.hpp"

namespace supple {

/// The public function of this name; `used_exact` is set when integers were needed, and otherwise left alone.
bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b, bool& used_exact);

/// The public function of this name, except that the normal is zero.
TriangleIntersection intersect_triangles_without_normal(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
