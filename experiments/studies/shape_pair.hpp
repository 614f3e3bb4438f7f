#pragma once

#include <cstdint>
#include <vector>

#include "supple/inspection.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"

namespace supple::experiments {

/// Rotates by 62 degrees around the diagonal (1, 2, 2), in rational numbers, with the same bits on every
/// machine.
TriangleMesh turned(TriangleMesh mesh);
TriangleMesh moved(TriangleMesh mesh, Vec3d offset);

/// The cost of one pair of objects by stage; each time is the minimum of several.
struct PairCost {
  double build_seconds = 0;  ///< time to add both objects, including their octrees
  double refit_seconds = 0;  ///< of both octrees
  double traversal_seconds = 0;
  OctreeStatistics octree_a, octree_b;
  StepStats stats;  ///< of the last step
};

/// Moves both objects by 2^-30 in every step, so that every octree is refitted. Runs the stages separately,
/// without exact tests. The octrees are regular.
PairCost cost_of_pair(const TriangleMesh& a, const TriangleMesh& b, const ObjectOctreeOptions& octree,
                      int frames, std::uint32_t threads, BoundingVolume volume = BoundingVolume::aabb,
                      Descent descent = Descent::both_sides);

/// The descent into the regular octrees of both objects.
NodePairList node_pairs_of(const TriangleMesh& a, const TriangleMesh& b, const ObjectOctreeOptions& octree);

}  // namespace supple::experiments
