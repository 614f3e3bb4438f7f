#pragma once

#include <span>
#include <vector>

#include "octree/octree_node.hpp"
#include "octree/surface_elements.hpp"
#include "octree/vertex_buffer.hpp"

namespace supple {

class ObjectOctree;

/// Bounds of the ways, end - start, of the vertices of each child, by node; without vertices that are not
/// finite. O(n).
void set_way_boxes(const ObjectOctree& octree, const SurfaceElements& elements, const VertexBuffer& start,
                   const VertexBuffer& end, std::vector<ChildBoxes>& ways);

}  // namespace supple
