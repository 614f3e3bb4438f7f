#pragma once

#include <array>
#include <cstdint>

#include "narrow_phase/overlap_kernels.hpp"
#include "octree/octree_node.hpp"

// Tests of a point, a box or a ray against the boxes of eight children or of a block of triangles. They never
// exclude a box that the exact test would not.
namespace supple {

/// A point as the boxes of an object see it: between two floats on each axis.
struct PointBounds {
  Vec3f low, high;
};

/// Writes the squared distances of the point and the boxes of eight children, in single precision: they are
/// below 1 + 2^-20 times the exact ones, plus 2^-140. Those of missing children are unspecified.
void squared_distances(const PointBounds& point, const ChildBoxes& boxes, std::array<float, 8>& squares);
/// The triangles of a block whose boxes have such a squared distance of at most `limit`.
std::uint64_t near_triangles(const PointBounds& point, const LeafBoxes& boxes, float limit);

/// A ray as the boxes of an object see it: its origin between two points, and the reciprocals of its
/// direction. An axis along which the direction is too small or too large for reciprocals is `unlimited`.
struct RaySlabs {
  Vec3d low, high, reciprocal;
  std::array<bool, 3> is_parallel{}, is_unlimited{};
};
/// Writes a lower bound of the parameters at which the ray is in each box; infinite when it misses the box.
void ray_bounds(const RaySlabs& ray, const ChildBoxes& boxes, std::array<double, 8>& bounds);
/// The triangles of a block whose boxes have such a bound of at most `limit`.
std::uint64_t triangles_on_ray(const RaySlabs& ray, const LeafBoxes& boxes, double limit);

}  // namespace supple
