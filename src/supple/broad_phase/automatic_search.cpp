#include "broad_phase/automatic_search.hpp"

#include "broad_phase/grid/grid_search.hpp"
#include "broad_phase/octree/octree_search.hpp"

namespace supple {
namespace {

/// An object that changed costs the octree as much as so many objects cost the grid.
constexpr std::size_t cost_of_change = 24;
/// A build of the octree costs as much as about two grid searches: so many steps in a row with few changes
/// make it likely that more follow.
constexpr std::uint32_t steps_before_build = 4;
/// The grid sorts all objects into cells before it can tell that the scene is too crowded.
constexpr std::uint32_t steps_between_tries = 64;

}  // namespace

AutomaticSearch::AutomaticSearch(BoundingVolume bounding_volume, const SceneOctreeOptions& octree_options)
    : octree_(std::make_unique<OctreeSearch>(bounding_volume, octree_options)),
      grid_(std::make_unique<GridSearch>()) {}

AutomaticSearch::~AutomaticSearch() = default;

void AutomaticSearch::search(VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  const bool few_changes = cost_of_change * volumes.changed().size() < volumes.slot_count();
  steps_with_few_changes_ = few_changes ? steps_with_few_changes_ + 1 : 0;
  steps_to_grid_ -= steps_to_grid_ != 0;
  ran_octree_ = steps_with_few_changes_ >= steps_before_build || steps_to_grid_ != 0;
  if (!ran_octree_ && !grid_->search_unless_crowded(volumes, parallel, found)) {
    ran_octree_ = true;
    steps_to_grid_ = steps_between_tries;
  }
  if (ran_octree_) octree_->search(volumes, parallel, found);
}

bool AutomaticSearch::needs_previous(const VolumeStore& volumes) const {
  return octree_->needs_previous(volumes);
}

std::vector<SceneRegion> AutomaticSearch::regions() const {
  return ran_octree_ ? octree_->regions() : std::vector<SceneRegion>();
}

std::string AutomaticSearch::validate(const VolumeStore& volumes) const {
  return ran_octree_ ? octree_->validate(volumes) : grid_->validate(volumes);
}

}  // namespace supple
