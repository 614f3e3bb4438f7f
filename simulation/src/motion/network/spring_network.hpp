#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "motion/network/closed_parts.hpp"
#include "supple/mesh.hpp"
#include "supple/motion.hpp"

namespace supple {

/// A spring between vertices a < b.
struct SpringElement {
  std::uint32_t a = 0, b = 0;
  double rest_length = 0;

  std::array<std::uint32_t, 2> vertices() const { return {a, b}; }
};

/// Preserves the area of a triangle. `inverse_scale` is one over the area of the equilateral triangle on its
/// longest side in the mesh. With the area itself, the stiffness of slivers would be unbounded.
struct AreaElement {
  Triangle corners{};
  double rest_area = 0;
  double inverse_scale = 0;

  const Triangle& vertices() const { return corners; }
};

/// Vertices per block of forces. A constant, so that the order of sums does not depend on the number of
/// threads. The positions, velocities and forces of a block fit the second level of cache.
constexpr std::uint32_t vertex_block_size = 2048;

/// Elements grouped by the block of their first vertex. Within a block, the elements inside it come first,
/// then those that cross into other blocks. Blocks add the forces of inside elements in place. Crossing
/// elements write to slots, one per vertex and element, grouped by vertex, so that threads need no locks.
template <class Element>
struct ElementBlocks {
  std::vector<Element> elements;
  std::vector<std::uint32_t> first;           ///< first element of each block, and the end
  std::vector<std::uint32_t> first_crossing;  ///< first crossing element of each block
  std::vector<std::uint32_t> slots;           ///< slots of all crossing elements in order, one per vertex
  std::vector<std::uint32_t> first_slot;      ///< first entry of each block in `slots`
};

/// A range [first, last) of consecutive elements of one part.
struct VolumeRun {
  std::uint32_t first = 0, last = 0;
  std::uint32_t part = 0;
};

/// The elements that act on the vertices of a mesh, and the slots for their forces.
struct SpringNetwork {
  std::uint32_t vertex_count = 0;
  /// One per pair of different vertices of a triangle, and those between pieces.
  ElementBlocks<SpringElement> edges;
  ElementBlocks<SpringElement> bending;  ///< one across each edge, unless it is itself an edge
  ElementBlocks<AreaElement> areas;      ///< triangles with positive area
  ElementBlocks<VolumeElement> volumes;  ///< triangles of `parts`
  std::vector<ClosedPart> parts;
  std::vector<VolumeRun> runs;  ///< cover `volumes` in order; no run crosses a block boundary
  /// The slots of vertex v are [first_slot[v], first_slot[v + 1]).
  std::vector<std::uint32_t> first_slot;

  std::uint32_t block_count() const { return (vertex_count + vertex_block_size - 1) / vertex_block_size; }
};

/// The springs on edges and between pieces, and those across edges and the areas when `options` give them a
/// stiffness. Omits elements with a vertex that is not finite, and elements whose size overflows double. An
/// edge of more than two triangles has one bending spring for each two that are consecutive in the mesh. O(n
/// log n).
SpringNetwork build_spring_network(const TriangleMesh& mesh, const MassSpringOptions& options,
                                   const ClosedParts& closed = {});

/// |(b - a) × (c - a)| / 2
double triangle_area(Vec3d a, Vec3d b, Vec3d c);

}  // namespace supple
