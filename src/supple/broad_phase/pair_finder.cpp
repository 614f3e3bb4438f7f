#include "broad_phase/pair_finder.hpp"

#include <string>

#include "broad_phase/brute_force.hpp"
#include "broad_phase/octree_broad_phase.hpp"
#include "broad_phase/sweep_and_prune.hpp"
#include "core/error.hpp"

namespace supple {

std::unique_ptr<PairFinder> make_pair_finder(BroadPhaseMethod method, BoundingVolume bounding_volume,
                                             const SceneOctreeOptions& octree_options) {
  constexpr std::uint32_t kDeepestLevel = 20;  // 8^20 regions are as many as a 64-bit number can tell apart
  if (octree_options.max_level > kDeepestLevel)
    fail("scene octree: max_level is " + std::to_string(octree_options.max_level) +
         "; it must be 1 to 20, or 0 to have it chosen");
  if (octree_options.expand_at < 2)
    fail("scene octree: expand_at is " + std::to_string(octree_options.expand_at) + "; it must be 2 or more");
  if (octree_options.arity != 2 && octree_options.arity != 4 && octree_options.arity != 8)
    fail("scene octree: arity is " + std::to_string(octree_options.arity) + "; it must be 2, 4 or 8");
  switch (method) {
    case BroadPhaseMethod::octree:
      return std::make_unique<OctreeBroadPhase>(bounding_volume, octree_options);
    case BroadPhaseMethod::sweep:
      return std::make_unique<SweepAndPrune>(bounding_volume);
    case BroadPhaseMethod::brute:
      return std::make_unique<BruteForce>(bounding_volume);
  }
  fail("broad phase: method " + std::to_string(static_cast<int>(method)) +
       " is unknown; use octree, sweep or brute");
}

}  // namespace supple
