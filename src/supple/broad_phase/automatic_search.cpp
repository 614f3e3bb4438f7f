#include "broad_phase/automatic_search.hpp"

namespace supple {
namespace {

/// The octree takes as long for one changed object as the grid takes for this number of objects.
constexpr std::size_t cost_of_change = 24;
/// Building the octree takes as long as about two grid searches. After this number of steps with few changes,
/// more such steps are likely to follow.
constexpr std::uint32_t steps_before_build = 4;
/// The grid sorts all objects into cells before it knows that the scene is too crowded.
constexpr std::uint32_t steps_between_tries = 64;

}  // namespace

void AutomaticSearch::search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  const bool few_changes = cost_of_change * volumes.changed().size() < volumes.slot_count();
  steps_with_few_changes_ = few_changes ? steps_with_few_changes_ + 1 : 0;
  steps_to_grid_ -= steps_to_grid_ != 0;
  ran_octree_ = steps_with_few_changes_ >= steps_before_build || steps_to_grid_ != 0;
  if (!ran_octree_ && !grid_.search_unless_crowded(volumes, parallel, found)) {
    ran_octree_ = true;
    steps_to_grid_ = steps_between_tries;
  }
  if (ran_octree_) octree_.search(volumes, parallel, found);
}

std::vector<SceneRegion> AutomaticSearch::regions(std::optional<std::uint32_t> slot) const {
  return ran_octree_ ? octree_.regions(slot) : std::vector<SceneRegion>();
}

std::string AutomaticSearch::validate(const VolumeStore& volumes) const {
  return ran_octree_ ? octree_.validate(volumes) : grid_.validate(volumes);
}

}  // namespace supple
