#pragma once

#include "supple/triangle_intersection.hpp"

namespace supple {

/// Where the relative interiors of `on_a` and `on_b` meet, given that they do in one point; the accuracy is
/// that of `intersect_triangles`.
Vec3d meeting_point(const TrianglePoints& a, Feature on_a, const TrianglePoints& b, Feature on_b);

}  // namespace supple
