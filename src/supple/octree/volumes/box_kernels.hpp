#pragma once

#include <cstdint>

#include "mesh/vertex_arrays.hpp"
#include "octree/octree_node.hpp"

namespace supple {

/// Computes the boxes of all leaves of the nodes [begin, end), and writes the box of each of these nodes into
/// its parent. The boxes of inner children must be there already. Nodes of one level may run in any order and
/// in parallel.
///
/// Returns false when a vertex is not finite, and possibly when coordinates are so large that their sums
/// overflow; then the boxes are invalid. With `arrays.inert`, inert triangles are left out and all others
/// count as finite. Chooses the widest instruction set at run time; the boxes are equal on all.
bool refit_boxes(const OctreeNode* nodes, ChildBoxes* boxes, const TriangleArrays& arrays,
                 const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end);

}  // namespace supple
