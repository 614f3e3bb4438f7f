#pragma once

#include "octree/object_octree.hpp"
#include "supple/inspection.hpp"
#include "world/object/world_object.hpp"

namespace supple {

/// The shape of an octree, without cost, memory and rebuilds.
OctreeStatistics octree_statistics(const ObjectOctree& octree);
/// `query_cost` by the surfaces of volumes other than boxes.
double cost_of_volumes(const ObjectOctree& octree);
/// All statistics of an object that is up to date.
OctreeStatistics octree_statistics(const WorldObject& object);

}  // namespace supple
