#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broad_phase/pair_search.hpp"

namespace supple {

/// The broad phase of a scene: the present volumes, their pairs, and the method that finds the pairs.
class PairFinder {
 public:
  /// Throws `Error` when an option is out of its range or has no effect with the method.
  PairFinder(BroadPhaseMethod method, BoundingVolume bounding_volume,
             const SceneOctreeOptions& octree_options, const WantedKinds& wanted = {});

  /// All overlapping pairs, sorted by (a, b), each once. The span lasts until the next call. When no volume
  /// changed, the method does not run and the pairs stay.
  /// After a call that threw an exception, the next one searches all volumes.
  std::span<const IndexPair> find_pairs(const ObjectVolumes& given, const Parallel& parallel);
  const BroadPhaseStats& stats() const { return found_.stats; }
  std::vector<SceneRegion> regions(std::optional<std::uint32_t> slot = {}) const {
    return search_->regions(slot);
  }
  std::string validate() const;

 private:
  void start_afresh();

  BroadPhaseMethod method_;
  BoundingVolume bounding_volume_;
  SceneOctreeOptions octree_options_;
  VolumeStore volumes_;
  std::unique_ptr<PairSearch> search_;
  bool is_complete_ = true;  // the last search
  FoundPairs found_;
};

}  // namespace supple
