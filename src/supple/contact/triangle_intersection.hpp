#pragma once

#include "supple/triangle_intersection.hpp"

namespace supple {

/// As the public functions of these names, which start with a test that rejects most pairs; here that test
/// has been made and did not decide. `used_exact` is set when integers were needed.
bool triangles_intersect_undecided(const TrianglePoints& a, const TrianglePoints& b, bool& used_exact);
TriangleIntersection intersect_triangles_undecided(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
