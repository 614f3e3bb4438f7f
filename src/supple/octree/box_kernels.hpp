#pragma once

#include <cstdint>

#include "mesh/vertex_arrays.hpp"
#include "octree/octree_node.hpp"

namespace supple {

/// The distinct vertices of each leaf: those of lane l of node n are `vertices[first[8 n + l]]` up to those
/// of the next lane, the last one again and again up to a multiple of `leaf_vertices_step`. Inner and unused
/// lanes have none. `leaf_vertices_ahead` more follow all of them: what is needed so much later is fetched
/// into the cache already.
constexpr std::size_t leaf_vertices_step = 4, leaf_vertices_ahead = 48;
///
/// `corners` has the corners of triangle t as places in its leaf's list, modulo 256, at t, t + stride and t +
/// 2 stride; `corners_ahead` more follow each.
constexpr std::size_t corners_ahead = 16;
struct LeafVertexArrays {
  const std::uint32_t* first = nullptr;
  const std::uint32_t* vertices = nullptr;
  const std::uint8_t* corners = nullptr;
  std::size_t stride = 0;
};

/// Boxes of all leaf lanes of the nodes [begin, end), and of each of these nodes but the root in its parent's
/// lane. Lanes of inner nodes must be there already; nodes of one level may run in any order and in parallel.
/// Returns false, the boxes being of no use, when a vertex is not finite; and it may be false when
/// coordinates are so large that their sums overflow. Of objects with inert triangles, which are left out,
/// the others are taken as finite. Chooses the widest instruction set at run time; the boxes are equal on
/// all.
bool refit_boxes(const OctreeNode* nodes, AabbLanes* boxes, const TriangleArrays& arrays,
                 const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end);

/// The box around all children of a node.
Aabb box_of_lanes(const AabbLanes& lanes);

}  // namespace supple
