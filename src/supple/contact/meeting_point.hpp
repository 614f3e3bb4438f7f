#pragma once

#include "supple/triangle_intersection.hpp"

namespace supple {

/// The point where the relative interiors of `on_a` and `on_b` meet. They meet in exactly one point. The
/// accuracy is that of `intersect_triangles`.
Vec3d meeting_point(const TrianglePoints& a, Feature on_a, const TrianglePoints& b, Feature on_b);

}  // namespace supple
