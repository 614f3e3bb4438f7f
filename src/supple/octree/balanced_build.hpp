#pragma once

#include <cstdint>
#include <span>

#include "octree/octree_build.hpp"

namespace supple {

/// Builds an octree top-down from the centres of triangles. Each node is cut in two by up to three rounds of
/// median cuts across the longest axis, so that leaves and nodes are about equally full: most leaves hold
/// half of `leaf_size`. A regular octree has as many of both as the cells of space happen to cut out.
///
/// No leaf above `max_level` has more than `leaf_size` triangles, also where centres are equal. A centre that
/// is not finite counts as the lower corner of the others. O(n log n). The result is the same on every machine.
OctreeTopology build_balanced_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options);

}  // namespace supple
