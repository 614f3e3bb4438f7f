#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/float_rounding.hpp"
#include "geometry/vector.hpp"
#include "octree/volumes/node_volumes.hpp"
#include "supple/types.hpp"

namespace supple {

/// The directions of k-DOPs besides the coordinate axes: first the diagonals of a cube, then those of its
/// faces. They are not of unit length, so that products with them are exact.
constexpr std::array<Vec3f, 10> slab_directions{
    Vec3f{1, 1, 1},  Vec3f{1, 1, -1}, Vec3f{1, -1, 1}, Vec3f{1, -1, -1}, Vec3f{1, 1, 0},
    Vec3f{1, -1, 0}, Vec3f{1, 0, 1},  Vec3f{1, 0, -1}, Vec3f{0, 1, 1},   Vec3f{0, 1, -1}};

/// The slabs of the children of one node: with D directions, 16 D floats. Those of direction d start at 16 d:
/// the lower ends of the eight children, then the upper ends.
constexpr std::size_t floats_per_slab = 2 * std::size_t{node_width};

/// Computes the slabs of all leaves of the nodes [begin, end), and writes those of each of these nodes into
/// its parent. The slabs of inner children must be there already. Rounded outward; infinite when coordinates
/// are so large that sums may overflow. Equal on all instruction sets.
void refit_slabs(const RefittedOctree& octree, std::span<const Vec3f> directions, float* slabs,
                 std::uint32_t begin, std::uint32_t end);

/// Three axes at right angles, of unit length except for rounding, and the point where distances along them
/// begin.
struct AxisFrame {
  std::array<Vec3f, 3> axes{};
  Vec3d origin{};
};

/// The lowest and the highest distance along each axis; inverted without points.
struct AxisExtents {
  std::array<float, 3> low{inverted, inverted, inverted}, high{-inverted, -inverted, -inverted};

 private:
  static constexpr float inverted = std::numeric_limits<float>::infinity();
};

/// Extends the extents by the vertices with these ids. The distance of a vertex has an error of at most 2^-21
/// of the distance between the vertex and the origin. Equal on all instruction sets.
void extend_extents(const AxisFrame& frame, const VertexBuffer& positions,
                    std::span<const std::uint32_t> vertices, AxisExtents& extents);

/// Writes the union of the slabs of the first `count` children in `children` as child `child` of `parent`.
void unite_slabs(const float* children, int count, std::size_t directions, float* parent, int child);

/// The oriented boxes of the children of a node, one array per number.
struct alignas(64) ChildOrientedBoxes {
  float center[3][node_width];
  float axes[3][3][node_width];  ///< axis, coordinate, child
  float half_lengths[3][node_width];
};

/// `NodeVolumes::clear_apart` for k-DOPs, by their slabs along the directions, and for oriented boxes, along
/// 15 axes (Gottschalk, Lin and Manocha, 1996). `a` and `b` are the entries of all nodes.
void clear_slabs_apart(std::span<const NodePair> pairs, std::span<const Vec3f> directions, const float* a,
                       const float* b, const RelativePlacement& placement, std::uint64_t* masks);
void clear_boxes_apart(std::span<const NodePair> pairs, const ChildOrientedBoxes* a,
                       const ChildOrientedBoxes* b, const RelativePlacement& placement, std::uint64_t* masks);

/// The slab along a direction of the points that have distances from `low` to `high` along it, moved. The
/// growth covers the rounding of the sums.
inline Slab moved_slab(Vec3f direction, double low, double high, Vec3d translation) {
  const double shift = dot(in_double(direction), translation);
  const double growth = 0x1p-48 * (std::abs(low) + std::abs(high) + 3 * largest_magnitude(translation));
  return {direction, round_down(low + shift - growth), round_up(high + shift + growth)};
}

}  // namespace supple
