#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "mesh/vertex_arrays.hpp"
#include "octree/octree_node.hpp"
#include "supple/options.hpp"

namespace supple {

/// The directions of k-DOPs besides the coordinate axes: first the diagonals of a cube, then those of its
/// faces. They are not of unit length, so that products with them are exact.
constexpr std::array<Vec3f, 10> slab_directions{
    Vec3f{1, 1, 1},  Vec3f{1, 1, -1}, Vec3f{1, -1, 1}, Vec3f{1, -1, -1}, Vec3f{1, 1, 0},
    Vec3f{1, -1, 0}, Vec3f{1, 0, 1},  Vec3f{1, 0, -1}, Vec3f{0, 1, 1},   Vec3f{0, 1, -1}};

/// Those of one kind; empty when it is not a k-DOP.
constexpr std::span<const Vec3f> slab_directions_of(BoundingVolume kind) {
  const std::span<const Vec3f> all = slab_directions;
  switch (kind) {
    case BoundingVolume::kdop14:
      return all.first(4);
    case BoundingVolume::kdop18:
      return all.last(6);
    case BoundingVolume::kdop26:
      return all;
    default:
      return {};
  }
}

/// The slabs of the children of one node: with D directions, 16 D floats. Those of direction d start at 16 d:
/// the lower ends of the eight children, then the upper ends.
constexpr std::size_t floats_per_slab = 2 * std::size_t{node_width};

/// Computes the slabs of all leaves of the nodes [begin, end), and writes those of each of these nodes into
/// its parent. The boxes of the nodes and the slabs of inner children must be there already. Rounded outward;
/// infinite when coordinates are so large that sums may overflow. Equal on all instruction sets.
void refit_slabs(const OctreeNode* nodes, const ChildBoxes* boxes, float* slabs,
                 std::span<const Vec3f> directions, const TriangleArrays& arrays,
                 const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end);

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
void extend_extents(const AxisFrame& frame, const TriangleArrays& arrays,
                    std::span<const std::uint32_t> vertices, AxisExtents& extents);

/// Writes the union of the slabs of the first `count` children in `children` as child `child` of `parent`.
void unite_slabs(const float* children, int count, std::size_t directions, float* parent, int child);

}  // namespace supple
