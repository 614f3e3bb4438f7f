#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/octree_build.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Balanced top-down octree over triangles by their centres: eight-wide nodes, each made by up to three
/// rounds of cuts in two. Leaves come out about equally full, at half of `leaf_size` mostly, and so do the
/// nodes above them; a regular octree has as many of both as the cells of space happen to cut out.
///
/// Triangles that hang together by vertices stay together: cuts go between such parts first, as these may go
/// different ways, unless their boxes would overlap too much. Within a part the longest axis is cut near the
/// median, rather in a gap than through a row of a grid (`MedianCut`). Equal centres are cut in the order of
/// the triangles, so that no leaf is larger than `leaf_size` above `max_level`. Non-finite centres are taken
/// as the lower corner of the rest. `first_level` is as for `build_octree`. O(n log n); the same everywhere.
OctreeTopology build_balanced_octree(std::span<const Vec3d> centers, std::span<const Triangle> triangles,
                                     std::size_t vertex_count, const ObjectOctreeOptions& options,
                                     std::uint32_t first_level = 0);

}  // namespace supple
