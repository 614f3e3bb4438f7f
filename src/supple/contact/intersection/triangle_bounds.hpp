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

/// Writes for triangle `a` of each pair at most the least of the depths of its corners: the products of a
/// unit vector, which may be rounded, and the way from `origin`. The array has space for a multiple of eight
/// numbers.
void bound_depths(const Vec3d& origin, const Vec3d& normal, const PlacedTriangles& triangles,
                  std::span<const TrianglePair> list, double* least);

}  // namespace supple
