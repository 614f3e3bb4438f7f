#pragma once

#include "supple/triangle_intersection.hpp"

namespace supple {

/// Floating point suffices for the point where an edge crosses a plane or a line when the errors of the
/// distances of its end points are below this fraction of their sum. The error of the crossing's parameter is
/// then at most twice as large.
inline constexpr double accepted_distance_error = 0x1p-46;

/// The point where the relative interiors of `on_a` and `on_b` meet. They meet in exactly one point. The
/// accuracy is that of `intersect_triangles`.
Vec3d meeting_point(const TrianglePoints& a, Feature on_a, const TrianglePoints& b, Feature on_b);

}  // namespace supple
