#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "supple/inspection.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"

namespace supple::experiments {

inline constexpr std::array models{"pawn", "fish", "rabbit", "human", "bike"};

/// Rotates by 62 degrees around the diagonal (1, 2, 2), in rational numbers, with the same bits on every
/// machine.
TriangleMesh turned(TriangleMesh mesh);
TriangleMesh moved(TriangleMesh mesh, Vec3d offset);

/// Two objects in several poses relative to each other.
struct PosedPair {
  std::string name;
  TriangleMesh a;
  std::vector<TriangleMesh> b;  ///< by pose
};

/// Pairs of models of the paper; the bikes are large. And two balls of 20 `frequency`² triangles.
std::vector<PosedPair> posed_pairs(bool with_bikes, std::uint32_t frequency);
PosedPair posed_pair(std::string name, const TriangleMesh& a, const TriangleMesh& b,
                     const std::vector<Vec3d>& offsets);

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

/// The mean level of the leaves; 0 for an octree without leaves.
double mean_depth(const OctreeStatistics& octree);

/// The children of nodes that overlap some child of the other node, over the colliding pairs of nodes of a
/// descent. A pair counts once for each side that has children.
struct CollidingChildren {
  std::uint64_t nodes = 0;     ///< counted
  std::uint64_t children = 0;  ///< sum over these
  std::uint64_t above = 0;     ///< nodes with more than half of the arity
  std::uint32_t most = 0;      ///< of one node

  CollidingChildren& operator+=(const CollidingChildren& other);
};

/// Counts the colliding children in the descent into two octrees of this arity.
CollidingChildren colliding_children(const NodePairList& list, std::uint32_t arity);
/// In the descent into the regular octrees of both objects.
CollidingChildren colliding_children(const TriangleMesh& a, const TriangleMesh& b,
                                     const ObjectOctreeOptions& octree);

}  // namespace supple::experiments
