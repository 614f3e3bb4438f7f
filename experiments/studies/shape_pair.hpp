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

/// The processor seconds of one pair of objects by stage, in each round, and what the last round counted.
struct PairCost {
  std::vector<double> build, refit, traversal;
  OctreeStatistics octree_a, octree_b;
  StepStats stats;
};

/// Moves both objects by 2^-30 in every round, so that every octree is refitted. Runs the stages separately,
/// without exact tests and with one thread. The octrees are regular.
PairCost cost_of_pair(const TriangleMesh& a, const TriangleMesh& b, const ObjectOctreeOptions& octree,
                      int rounds, const SceneOptions& options = {});

/// The descent into the regular octrees of both objects.
NodePairList node_pairs_of(const TriangleMesh& a, const TriangleMesh& b, const ObjectOctreeOptions& octree);

}  // namespace supple::experiments
