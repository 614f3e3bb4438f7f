#include "broad_phase/pair_finder.hpp"

#include <string>

#include "broad_phase/brute_force.hpp"
#include "broad_phase/octree_broad_phase.hpp"
#include "broad_phase/sweep_and_prune.hpp"
#include "core/error.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {

std::unique_ptr<PairFinder> make_pair_finder(BroadPhaseMethod method, BoundingVolume bounding_volume,
                                             const SceneOctreeOptions& octree_options) {
  check(octree_options);
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
