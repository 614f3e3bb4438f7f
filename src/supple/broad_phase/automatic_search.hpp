#pragma once

#include <memory>

#include "broad_phase/pair_search.hpp"
#include "supple/options.hpp"

namespace supple {

class GridSearch;
class OctreeSearch;

/// Runs the octree or the grid in each step, by the rule of `BroadPhaseMethod::automatic`.
class AutomaticSearch final : public PairSearch {
 public:
  AutomaticSearch(BoundingVolume bounding_volume, const SceneOctreeOptions& octree_options);
  ~AutomaticSearch() override;

  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;
  std::vector<SceneRegion> regions(std::optional<std::uint32_t> slot) const override;
  std::string validate(const VolumeStore& volumes) const override;

 private:
  std::unique_ptr<OctreeSearch> octree_;
  std::unique_ptr<GridSearch> grid_;
  bool ran_octree_ = false;
  std::uint32_t steps_with_few_changes_ = 0;  // in a row, until now
  std::uint32_t steps_to_grid_ = 0;           // until a crowded scene tries the grid again
};

}  // namespace supple
