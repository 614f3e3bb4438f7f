#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
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

inline bool contains(const Aabb& box, const Vec3d& point) {
  bool is_in = true;
  for (int axis = 0; axis < 3; ++axis) is_in &= box.min[axis] <= point[axis] && point[axis] <= box.max[axis];
  return is_in;
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
/// Cells that divide a box, and one more around them on each side. A cell has an interval of each coordinate,
/// also as places are rounded.
struct CellGrid {
  using Cell = std::array<std::uint32_t, 3>;
  /// In parts of cells: 15 bits for each axis, with a zero above.
  using Place = std::uint64_t;
  static constexpr std::uint32_t parts = 8, most_along = 4096;
  static constexpr Place all_parts = 0x7fff, guards = 0x8000'8000'8000;
  static constexpr std::size_t block = 64;

  Vec3d low, high, scale;  ///< the corners of the box; cells per length
  Cell counts{};

  Place place_of(const Vec3d& point) const {
    Place place = 0;
    for (int axis = 3; axis-- > 0;) {
      const double along = parts * ((point[axis] - low[axis]) * scale[axis]),
                   last = parts * counts[static_cast<std::size_t>(axis)] - 1.0;
      place = place << 16 | static_cast<Place>(static_cast<std::int32_t>(std::min(along, last)));
    }
    return place;
  }
  /// Whether no coordinate of the first place is greater than that of the second.
  static bool are_ordered(Place a, Place b) { return (((b | guards) - a) & guards) == guards; }
  static Cell cell_of(Place place) {
    const auto cell = [&](int axis) {
      return static_cast<std::uint32_t>(place >> 16 * axis & all_parts) / parts;
    };
    return {cell(0), cell(1), cell(2)};
  }
  /// From a cell to the next one along an axis.
  int step(int axis) const {
    const int row = static_cast<int>(counts[0]) + 2, layer = row * (static_cast<int>(counts[1]) + 2);
    return axis == 0 ? 1 : axis == 1 ? row : layer;
  }
  std::size_t index_of(const Cell& cell) const {
    std::size_t index = 0;
    for (int axis = 0; axis < 3; ++axis)
      index += (cell[static_cast<std::size_t>(axis)] + 1) * static_cast<std::size_t>(step(axis));
    return index;
  }
  std::size_t size() const { return static_cast<std::size_t>(step(2)) * (counts[2] + 2); }
};
/// The indices of the cells of at most a block of points; 0 outside the box.
void find_cells(const CellGrid& grid, std::span<const Vec3d> points,
                std::array<std::uint32_t, CellGrid::block>& cells);

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
