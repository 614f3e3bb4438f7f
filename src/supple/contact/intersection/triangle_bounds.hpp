#pragma once

#include <span>

#include "mesh/vertex_arrays.hpp"
#include "supple/types.hpp"

namespace supple {

/// Writes two numbers for each pair, between which the distance of triangle `a` and point `b` of the pair is.
/// They are almost always nearly equal: the distance of a plane beyond which the triangle lies, and that of a
/// point of the triangle. Where rounding leaves nothing certain, they are 0 and infinite. Both arrays have
/// space for a multiple of eight numbers.
void bound_distances(std::span<const Vec3d> points, const PlacedTriangles& triangles,
                     std::span<const TrianglePair> list, double* lower, double* upper);

}  // namespace supple
