#pragma once

#include <span>

#include "octree/octree_node.hpp"
#include "octree/volumes/node_volumes.hpp"

namespace supple {

/// The expected cost of a query whose box meets the object's, in visits of children, by the surface-area
/// heuristic: a query that meets a box of surface R meets a box of surface S inside of it with probability
/// S / R. (Goldsmith and Salmon, "Automatic creation of object hierarchies for ray tracing", 1987.) A leaf
/// costs a visit, and an eighth for each of its triangles. Moving or scaling the object does not change the
/// cost.
///
/// 0 when the boxes have no surface or one that is too large for double. O(nodes). The same number on every
/// machine.
double query_cost(std::span<const OctreeNode> nodes, const ChildBoxes* boxes);
/// The same by the surfaces of the spheres. `object` is the sphere of the whole object.
double query_cost(std::span<const OctreeNode> nodes, const ChildSpheres* spheres,
                  const BoundingSphere& object);
/// The same by the surfaces of the oriented boxes or k-DOPs.
double query_cost(std::span<const OctreeNode> nodes, const ChildBoxes* boxes, const NodeVolumesView& volumes);

}  // namespace supple
