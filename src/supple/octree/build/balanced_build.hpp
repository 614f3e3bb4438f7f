#pragma once

#include <span>

#include "core/parallel.hpp"
#include "octree/octree_topology.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"

namespace supple {

/// Builds an octree over the centres of triangles, in O(n log n). Up to three rounds of cuts near the median
/// of the longest axis divide each node into children, so that leaves and nodes are about equally full: most
/// leaves contain half of `leaf_size`. Connected parts of the mesh, by vertex ids, stay whole as far as
/// possible.
///
/// No leaf above `max_level` has more than `leaf_size` triangles, also where centres are equal. A centre that
/// is not finite counts as the lower corner of the others. The result is the same on every machine.
OctreeTopology build_balanced_octree(std::span<const Vec3d> centers, std::span<const Triangle> triangles,
                                     const ObjectOctreeOptions& options, const Parallel& parallel);

}  // namespace supple
