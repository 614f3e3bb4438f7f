#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "narrow_phase/overlap_kernels.hpp"
#include "octree/octree_node.hpp"
#include "supple/queries.hpp"

// Tests of a point, a box or a ray against the boxes of eight children or of a block of triangles. They never
// exclude a box that the exact test would not.
namespace supple {

/// The box of no points.
inline QueryBox no_box() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}
/// Adds a box, or a point as both corners.
inline void extend(QueryBox& box, const Vec3d& min, const Vec3d& max) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], min[axis]);
    box.max[axis] = std::max(box.max[axis], max[axis]);
  }
}
inline QueryBox box_around(std::span<const Vec3d> points) {
  QueryBox box = no_box();
  for (const Vec3d& p : points) extend(box, p, p);
  return box;
}

/// Writes the squared distances of a point, which is in the box `point`, and the boxes of eight children, in
/// single precision: they are below 1 + 2^-20 times the exact ones, plus 2^-140. Those of missing children
/// are unspecified.
void squared_distances(const Aabb& point, const ChildBoxes& boxes, std::array<float, 8>& squares);
/// The triangles of a block whose boxes have such a squared distance of at most `limit`.
std::uint64_t near_triangles(const Aabb& point, const LeafBoxes& boxes, float limit);

/// The corners of the triangles of a block, rounded; those of inert triangles are infinite.
struct alignas(64) LeafCorners {
  float corners[3][3][leaf_block];  ///< by corner and axis
  /// A third of the square of the longest edge. The square of the distance of a point to any point of the
  /// triangle is at least the least of those to its corners minus this.
  float spread[leaf_block];
  std::uint32_t size;
  /// A cylinder around the corners: its middle, the direction of its axis or 0, its radius and half its
  /// height.
  Vec3f middle, axis;
  float radius, height;
};
/// Points whose nearest triangles are searched for together, rounded, as the boxes of an object see them.
struct alignas(64) PointPacket {
  static constexpr std::size_t capacity = 8;
  float points[3][capacity];  ///< by axis
  float limits[capacity];     ///< squares of the distances of interest, with what rounding changes
  float slack;                ///< more than rounding changes a distance
};
/// Writes the least squared distance of a point and each of eight children, infinite where it exceeds the
/// limits of all points.
void squared_distances(const PointPacket& points, const ChildBoxes& boxes, std::array<float, 8>& squares);
/// Limits each point to its nearest corner. Returns the triangles that are within the limit of a point, and
/// writes squares of lower bounds for these.
using PacketBounds = std::array<std::array<float, PointPacket::capacity>, leaf_block>;
std::uint64_t near_triangles(PointPacket& points, const LeafCorners& leaf, PacketBounds& squares);

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
