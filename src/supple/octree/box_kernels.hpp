#pragma once

#include <cstdint>
#include <span>

#include "octree/octree_node.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// What the box kernels read of an object: raw arrays, so that they compile for every instruction set alike.
/// One of `floats` and `doubles` is set, four scalars a vertex; `inert` has a byte a triangle or is null.
struct TriangleArrays {
  const Triangle* triangles = nullptr;
  const float* floats = nullptr;
  const double* doubles = nullptr;
  const std::uint8_t* inert = nullptr;
};

/// Boxes of all leaf lanes of the nodes [begin, end), and of each of these nodes but `root` in its parent's
/// lane. Lanes of inner nodes must be there already; nodes of one level may run in any order and in parallel.
/// Chooses the widest instruction set at run time; the boxes are equal on all.
void refit_boxes(const OctreeNode* nodes, AabbLanes* boxes, const TriangleArrays& arrays, std::uint32_t begin,
                 std::uint32_t end, std::uint32_t root);

/// Box of the vertices [begin, end) and of the `others`, all of them finite; empty when there are none.
Aabb box_of_vertices(const TriangleArrays& arrays, std::uint32_t begin, std::uint32_t end,
                     std::span<const std::uint32_t> others);

/// Box of all lanes of a node.
Aabb box_of_lanes(const AabbLanes& lanes);

}  // namespace supple
