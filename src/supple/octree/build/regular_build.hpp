#pragma once

#include <span>

#include "octree/octree_topology.hpp"
#include "supple/options.hpp"

namespace supple {

/// Builds the paper's regular octree over the centres of triangles, in O(n log n): the children of a node are
/// the octants of its cell. A centre that is not finite counts as the lower corner of the others. Equal
/// centres cannot be split and may leave a leaf larger than `leaf_size`.
OctreeTopology build_regular_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options);

}  // namespace supple
