#pragma once

#include <cstdint>
#include <vector>

#include "supple/inspection.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"

namespace supple::experiments {

/// Turns by 62 degrees about the diagonal (1, 2, 2), in rational numbers: the same bits everywhere.
TriangleMesh turned(TriangleMesh mesh);
TriangleMesh moved(TriangleMesh mesh, Vec3d offset);

/// What one pair of objects costs, step by step; times are the least of several.
struct PairCost {
  double build_seconds = 0;  ///< of both octrees, with all that adding objects takes
  double refit_seconds = 0;  ///< of both
  double traversal_seconds = 0;
  OctreeStatistics octree_a, octree_b;
  StepStats stats;  ///< of the last step
};

/// Both objects get new positions at every step, 2^-30 aside, so that every octree is refitted. Stage by
/// stage: no exact tests.
PairCost cost_of_pair(const TriangleMesh& a, const TriangleMesh& b, const ObjectOctreeOptions& octree,
                      int frames, std::uint32_t threads, BoundingVolume volume = BoundingVolume::aabb);

}  // namespace supple::experiments
