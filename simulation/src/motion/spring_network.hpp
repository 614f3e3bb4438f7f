#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "motion/closed_parts.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Pulls at its two ends. a < b
struct SpringElement {
  std::uint32_t a = 0, b = 0;
  double rest_length = 0;

  std::array<std::uint32_t, 2> vertices() const { return {a, b}; }
};

/// Pulls at the corners of a triangle. `inverse_scale` is one over the area of the equilateral triangle on
/// its longest side: over the area itself slivers would be stiff without bound.
struct AreaElement {
  Triangle corners{};
  double rest_area = 0;
  double inverse_scale = 0;

  const Triangle& vertices() const { return corners; }
};

/// Vertices that share a block of forces. Fixed, so that sums have one order for any number of threads; a
/// block's positions, velocities and forces stay in the second level of cache.
constexpr std::uint32_t vertex_block_size = 2048;

/// Elements by the block of their first vertex; within a block, first those that stay inside it, then those
/// that cross into others. Blocks add up the forces of the former in place. The latter hand theirs in at
/// slots, one for each vertex of each, which lie vertex by vertex, so that nobody waits for anybody.
template <class Element>
struct ElementBlocks {
  std::vector<Element> elements;
  std::vector<std::uint32_t> first;           ///< of a block; one more at the end
  std::vector<std::uint32_t> first_crossing;  ///< of a block
  std::vector<std::uint32_t> slots;           ///< of all that cross, in order, one a vertex
  std::vector<std::uint32_t> first_slot;      ///< of a block, in `slots`
};

/// Elements of one part that follow each other: [first, last).
struct VolumeRun {
  std::uint32_t first = 0, last = 0;
  std::uint32_t part = 0;
};

/// What pulls at the vertices of a mesh, and where forces are gathered.
struct SpringNetwork {
  std::uint32_t vertex_count = 0;
  ElementBlocks<SpringElement> edges;    ///< one for each pair of different vertices of a triangle
  ElementBlocks<SpringElement> bending;  ///< one across each edge, where that is no edge itself
  ElementBlocks<AreaElement> areas;      ///< triangles with an area
  ElementBlocks<VolumeElement> volumes;  ///< triangles of `parts`
  std::vector<ClosedPart> parts;
  std::vector<VolumeRun> runs;  ///< of `volumes`, all of them in order; none goes from a block into the next
  /// Slots of vertex v: [first_slot[v], first_slot[v + 1]).
  std::vector<std::uint32_t> first_slot;

  std::uint32_t block_count() const { return (vertex_count + vertex_block_size - 1) / vertex_block_size; }
};

/// Elements of vertices that are not finite are left out, and those whose size is beyond the range of double.
/// An edge of many triangles has a bending spring for each two that follow each other in the mesh. O(n log
/// n).
SpringNetwork build_spring_network(const TriangleMesh& rest, bool with_bending, bool with_areas,
                                   const ClosedParts& closed = {});

/// |(b - a) × (c - a)| / 2
double triangle_area(Vec3d a, Vec3d b, Vec3d c);

}  // namespace supple
