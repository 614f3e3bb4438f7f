#pragma once

#include "broad_phase/grid/grid_search.hpp"
#include "broad_phase/octree/octree_search.hpp"
#include "broad_phase/pair_search.hpp"
#include "supple/options.hpp"

namespace supple {

/// Runs the octree or the grid in each step, by the rule of `BroadPhaseMethod::automatic`.
class AutomaticSearch final : public PairSearch {
 public:
  AutomaticSearch(BoundingVolume bounding_volume, const SceneOctreeOptions& octree_options)
      : octree_(bounding_volume, octree_options) {}

  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;
  std::vector<SceneRegion> regions(std::optional<std::uint32_t> slot) const override;
  std::string validate(const VolumeStore& volumes) const override;

 private:
  OctreeSearch octree_;
  GridSearch grid_;
  bool ran_octree_ = false;
  std::uint32_t steps_with_few_changes_ = 0;  // in a row, until now
  std::uint32_t steps_to_grid_ = 0;           // until a crowded scene tries the grid again
};

}  // namespace supple
