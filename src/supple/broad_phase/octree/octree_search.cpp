#include "broad_phase/octree/octree_search.hpp"

#include <algorithm>

#include "geometry/sphere.hpp"

namespace supple {
namespace {

/// Fewer objects than this in a leaf are tested each against each: sorting them first would take longer.
constexpr std::uint32_t sort_leaf_at = 96;

/// The search of one object costs as much as the share of so many objects in a search of all.
constexpr std::size_t cost_of_object = 6;

/// Bit per axis: the box begins in this region and not below it.
///
/// The intersection of two boxes that share a leaf has its lower corner at the larger of their lower ends.
/// That corner is in exactly one leaf L, as half-open regions part all of space, and both boxes touch L:
/// along each axis and for each plane above L, if the corner is below the plane so are the lower ends of
/// both, and if it is not, neither are the upper ends, which are no less than the corner. Among the leaves
/// they share, where every lower end is below each upper side, L is the one whose lower sides are all <= the
/// corner: along each axis one of the two boxes begins there. Reporting a pair in L alone reports it once.
std::uint32_t begins_in(const SceneOctree::Region& leaf, const Aabb& box) {
  return static_cast<std::uint32_t>((box.min.x >= leaf.lower.x) | (box.min.y >= leaf.lower.y) << 1 |
                                    (box.min.z >= leaf.lower.z) << 2);
}

}  // namespace

void OctreeSearch::search(VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  const std::uint64_t expanded = tree_.expanded_count(), reduced = tree_.reduced_count();
  if (volumes.holds_previous()) {
    follow_changes(volumes, found.stats);
  } else {
    volumes.take_changed();
    build(volumes, cube_chooser_.choose(volumes.boxes()), found.stats);
    found.stats.objects_placed = tree_.object_count();
  }
  revision_ = volumes.revision();
  found.stats.method = BroadPhaseMethod::octree;
  found.stats.regions_expanded = tree_.expanded_count() - expanded;
  found.stats.regions_reduced = tree_.reduced_count() - reduced;

  const auto changed = volumes.changed();
  const bool few_changed = cost_of_object * changed.size() < tree_.object_count();
  workers_.resize(parallel.worker_count());
  for (Worker& worker : workers_) worker.tests = 0;
  const auto bins = sorter_.start(parallel.worker_count(), volumes.slot_count());
  constexpr std::size_t grain = 64;
  if (few_changed) {
    is_changed_.resize(volumes.slot_count(), 0);
    for (const std::uint32_t slot : changed) is_changed_[slot] = 1;
    parallel.for_ranges(changed.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
      for (std::size_t i = begin; i < end; ++i)
        find_of_object(volumes, changed[i], workers_[worker], bins[worker]);
    });
    found.stats.objects_paired = changed.size();
    sorter_.finish(parallel, fresh_);
    merge_kept(found.pairs);
    for (const std::uint32_t slot : changed) is_changed_[slot] = 0;
  } else {
    const auto regions = tree_.regions();
    parallel.for_ranges(regions.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
      for (std::size_t i = begin; i < end; ++i)
        if (regions[i].in_use && regions[i].objects.count > 1)
          find_in_leaf(volumes, regions[i], workers_[worker], bins[worker]);
    });
    found.stats.objects_paired = tree_.object_count();
    sorter_.finish(parallel, found.pairs);
  }
  for (const Worker& worker : workers_) found.stats.object_pairs_tested += worker.tests;
}

/// Objects that stay in their regions only have their volumes taken.
void OctreeSearch::follow_changes(VolumeStore& volumes, BroadPhaseStats& stats) {
  crossing_.clear();
  previous_.clear();
  for (const std::uint32_t slot : volumes.changed()) {
    const ObjectVolume previous = volumes.volume(slot);
    const bool stays = !previous.box.empty() && tree_.stays(slot, volumes.incoming(slot));
    volumes.take(slot);
    if (stays) continue;
    crossing_.push_back(slot);
    previous_.push_back(previous);
  }
  stats.objects_placed = crossing_.size();
  // Moving an object costs a little more than its share of a build.
  const bool many = 4 * crossing_.size() > 3 * tree_.object_count();
  if (!many) {
    for (std::size_t i = 0; i < crossing_.size(); ++i) tree_.move(volumes, crossing_[i], previous_[i]);
    tree_.settle(volumes);
  }
  // When all objects have moved once more, the scene may have another extent or number of objects.
  const bool is_due = crossing_.size() >= placements_before_choice_;
  placements_before_choice_ -= is_due ? 0 : crossing_.size();
  if (!many && !is_due) return;
  const SceneCube cube = cube_chooser_.choose(volumes.boxes());
  if (many || tree_.is_outdated(cube)) build(volumes, cube, stats);
  placements_before_choice_ = std::max<std::size_t>(tree_.object_count(), 64);
}

void OctreeSearch::build(const VolumeStore& volumes, const SceneCube& cube, BroadPhaseStats& stats) {
  tree_.build(volumes, cube);
  placements_before_choice_ = std::max<std::size_t>(tree_.object_count(), 64);
  stats.regions_rebuilt = 1;
}

void OctreeSearch::find_in_leaf(const VolumeStore& volumes, const SceneOctree::Region& leaf, Worker& worker,
                                PairBins& pairs) const {
  const auto slots = tree_.objects(leaf);
  const auto boxes = volumes.boxes();
  const auto begins = [&](const Aabb& box) {
    return tree_.placed_by_sphere() ? std::uint32_t{7} : begins_in(leaf, box);
  };
  worker.lanes.resize(slots.size());
  if (slots.size() < sort_leaf_at) {
    for (std::size_t i = 0; i < slots.size(); ++i)
      worker.lanes.set(i, slots[i], boxes[slots[i]], begins(boxes[slots[i]]));
    worker.tests += find_overlaps(worker.lanes, 0, slots.size(), volumes.spheres(), pairs);
    return;
  }
  worker.order.clear();
  for (const std::uint32_t slot : slots) worker.order.push_back(order_key(boxes[slot].min.x, slot));
  std::sort(worker.order.begin(), worker.order.end());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const auto slot = static_cast<std::uint32_t>(worker.order[i]);
    worker.lanes.set(i, slot, boxes[slot], begins(boxes[slot]));
  }
  worker.tests += find_overlaps_sorted(worker.lanes, 0, slots.size(), volumes.spheres(), pairs);
}

void OctreeSearch::find_of_object(const VolumeStore& volumes, std::uint32_t slot, Worker& worker,
                                  PairBins& pairs) const {
  const auto boxes = volumes.boxes();
  const ObjectVolume volume = volumes.volume(slot);
  tree_.visit_leaves(volume, [&](const SceneOctree::Region& leaf) {
    const std::uint32_t begins = tree_.placed_by_sphere() ? std::uint32_t{7} : begins_in(leaf, volume.box);
    find_overlaps_of(volume.box, boxes, tree_.objects(leaf), worker.others);
    std::size_t count = 0;
    for (const std::uint32_t other : worker.others) {
      // Of two objects that changed, the one with the smaller index finds the pair.
      if (other == slot || (other < slot && is_changed_[other] != 0)) continue;
      if ((begins | begins_in(leaf, boxes[other])) != 7) continue;
      pairs.first[count] = slot;
      pairs.second[count++] = other;
      if (count <= PairBins::batch_size) continue;
      pairs.flush(count, volumes.spheres());
      count = 0;
    }
    pairs.flush(count, volumes.spheres());
    worker.tests += leaf.objects.count - 1;
  });
}

/// Puts the pairs of objects that did not change and those found now in order.
void OctreeSearch::merge_kept(std::vector<IndexPair>& pairs) {
  kept_.swap(pairs);
  pairs.reserve(kept_.capacity());
  std::erase_if(kept_, [&](IndexPair pair) { return is_changed_[pair.a] != 0 || is_changed_[pair.b] != 0; });
  pairs.resize(kept_.size() + fresh_.size());
  std::merge(kept_.begin(), kept_.end(), fresh_.begin(), fresh_.end(), pairs.begin());
}

}  // namespace supple
