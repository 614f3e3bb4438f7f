#pragma once

#include <span>

#include "octree/octree_topology.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/views.hpp"

namespace supple {

/// Builds an octree from its leaves to its root in O(n log n). Triangles merge into leaves of up to
/// `leaf_size` triangles. Leaves merge into nodes of up to `arity` children, and so do nodes, up to the root.
/// Where the octree would be deeper than `max_level` allows, its deepest nodes are leaves.
///
/// Clusters lie in the order of the Morton curve through the centres. In each round, each cluster chooses the
/// cluster near it along the curve with which it has the smallest common box, and clusters that chose each
/// other merge. Clusters that lie too far apart merge only while clusters are less than half full. (Meister
/// and Bittner, "Parallel locally-ordered clustering for bounding volume hierarchy construction", 2018.)
/// There, merging makes a binary tree. Here, it makes clusters of limited size, which become the leaves and
/// nodes.
///
/// A triangle with a vertex that is not finite has no box, so it merges with any neighbour.
OctreeTopology build_bottom_up_octree(const PositionsView& positions, std::span<const Triangle> triangles,
                                      std::span<const Vec3d> centers, const ObjectOctreeOptions& options);

/// Builds the paper's regular octree over the centres of triangles, in O(n log n): the children of a node are
/// the octants of its cell. A centre that is not finite counts as the lower corner of the others. Equal
/// centres cannot be split and may leave a leaf larger than `leaf_size`.
OctreeTopology build_regular_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options);

}  // namespace supple
