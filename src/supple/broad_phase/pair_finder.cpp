#include "broad_phase/pair_finder.hpp"

#include <algorithm>

#include "broad_phase/grid/grid_search.hpp"
#include "broad_phase/octree/octree_search.hpp"
#include "core/error.hpp"
#include "octree/comparison_methods.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {
namespace {

/// Runs the octree or the grid in each step, by the rule of `BroadPhaseMethod::automatic`.
class AutomaticSearch final : public PairSearch {
 public:
  AutomaticSearch(BoundingVolume bounding_volume, const SceneOctreeOptions& octree_options)
      : octree_(bounding_volume, octree_options) {}

  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override {
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
  std::vector<SceneRegion> regions(std::optional<std::uint32_t> slot) const override {
    return ran_octree_ ? octree_.regions(slot) : std::vector<SceneRegion>();
  }
  std::string validate(const VolumeStore& volumes) const override {
    return ran_octree_ ? octree_.validate(volumes) : std::string();
  }

 private:
  /// The octree takes as long for one changed object as the grid takes for this number of objects.
  static constexpr std::size_t cost_of_change = 24;
  /// Building the octree takes as long as about two grid searches. After this number of steps with few
  /// changes, more such steps are likely to follow.
  static constexpr std::uint32_t steps_before_build = 4;
  /// The grid sorts all objects into cells before it knows that the scene is too crowded.
  static constexpr std::uint32_t steps_between_tries = 64;

  OctreeSearch octree_;
  GridSearch grid_;
  bool ran_octree_ = false;
  std::uint32_t steps_with_few_changes_ = 0;  // in a row, until now
  std::uint32_t steps_to_grid_ = 0;           // until a crowded scene tries the grid again
};

void refuse(const SceneOctreeOptions& options, const char* method) {
  if (options != SceneOctreeOptions{})
    fail(std::string("broad phase: options of the scene octree have no effect with the method ") + method +
         "; leave them at their defaults, or choose octree or automatic");
}

std::unique_ptr<PairSearch> make_search(BroadPhaseMethod method, BoundingVolume bounding_volume,
                                        const SceneOctreeOptions& options) {
  check(options);
  if (options.expand_for_large_objects && (options.max_level == 0 || options.max_level > most_full_levels)) {
    fail(
        "broad phase: the scene octree expands for large objects down to its deepest level, so max_level "
        "must "
        "be from 1 to " +
        std::to_string(most_full_levels) + "; it is " + std::to_string(options.max_level));
  }
  switch (method) {
    case BroadPhaseMethod::automatic:
      return std::make_unique<AutomaticSearch>(bounding_volume, options);
    case BroadPhaseMethod::octree:
      return std::make_unique<OctreeSearch>(bounding_volume, options);
    case BroadPhaseMethod::grid:
      refuse(options, "grid");
      return std::make_unique<GridSearch>();
    case BroadPhaseMethod::sweep:
    case BroadPhaseMethod::brute:
    case BroadPhaseMethod::sweep3:
      refuse(options, word_of(method));
      return comparison_methods(std::string("the broad phase ") + word_of(method)).pair_search(method);
  }
  fail("broad phase: method " + std::to_string(static_cast<int>(method)) +
       " is unknown; use automatic, octree, grid, sweep, brute or sweep3");
}

}  // namespace

PairFinder::PairFinder(BroadPhaseMethod method, BoundingVolume bounding_volume,
                       const SceneOctreeOptions& octree_options, const WantedKinds& wanted)
    : method_(method),
      bounding_volume_(bounding_volume),
      octree_options_(octree_options),
      volumes_(bounding_volume, wanted),
      search_(make_search(method, bounding_volume, octree_options)) {
  found_.stats.method = method == BroadPhaseMethod::automatic ? BroadPhaseMethod::grid : method;
}

std::span<const IndexPair> PairFinder::find_pairs(const ObjectVolumes& given, const Parallel& parallel) {
  found_.stats = {.method = found_.stats.method};
  ObjectVolumes wanted = given;
  if (!is_complete_) {
    start_afresh();
    wanted.dirty = std::nullopt;
  }
  is_complete_ = false;
  volumes_.update(wanted, parallel);
  found_.stats.objects_changed = volumes_.changed().size();
  if (found_.stats.objects_changed != 0) search_->search(volumes_, parallel, found_);
  is_complete_ = true;
  return found_.pairs;
}

/// When memory ran out, the volumes may be those of the failed step, and the search may know half of them.
void PairFinder::start_afresh() {
  search_ = make_search(method_, bounding_volume_, octree_options_);
  volumes_ = VolumeStore(bounding_volume_, volumes_.wanted());
  found_.pairs.clear();
}

std::string PairFinder::validate() const {
  if (!is_complete_) return "";  // the next search uses nothing of it
  const auto& pairs = found_.pairs;
  if (!std::is_sorted(pairs.begin(), pairs.end()) ||
      std::adjacent_find(pairs.begin(), pairs.end()) != pairs.end())
    return "broad phase: the pairs are not sorted, or one appears twice";
  return search_->validate(volumes_);
}

}  // namespace supple
