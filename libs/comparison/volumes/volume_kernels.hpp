#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

/// Calls `visit(vertex)` for the corners of the triangles of a child that are not inert; for the vertices of
/// a leaf once.
template <class Visit>
void for_each_vertex(const RefittedOctree& octree, std::uint32_t n, int child, const Visit& visit) {
  const OctreeNode& node = octree.nodes[n];
  if (octree.inert.empty() && !node.is_inner(child)) {
    const std::uint32_t* const first = octree.leaves.first + std::size_t{n} * node_width + child;
    std::for_each(octree.leaves.vertices + first[0], octree.leaves.vertices + first[1], visit);
    return;
  }
  for (std::uint32_t t = node.first_triangle[child]; t < node.first_triangle[child + 1]; ++t) {
    if (octree.inert.empty() || octree.inert[t] == 0) std::ranges::for_each(octree.triangles[t], visit);
  }
}

/// Calls `visit(vertex)` once for each vertex that a triangle uses, in the order of the positions in memory.
template <class Visit>
void for_each_used_vertex(const VertexBuffer& vertices, std::span<const std::uint32_t> unused_vertices,
                          const Visit& visit) {
  const auto count = static_cast<std::uint32_t>(vertices.size());
  std::uint32_t vertex = 0;
  for (const std::uint32_t unused : unused_vertices) {
    for (; vertex < unused; ++vertex) visit(vertex);
    ++vertex;
  }
  for (; vertex < count; ++vertex) visit(vertex);
}

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
