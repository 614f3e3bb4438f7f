#include "broad_phase/octree/octree_search.hpp"

#include <hwy/cache_control.h>

#include <algorithm>

namespace supple {
namespace {

/// In smaller leaves every pair is tested, because sorting the objects would take longer.
constexpr std::uint32_t sort_leaf_at = 96;

/// To search one object alone takes as long as to search this number of objects together with all others.
constexpr std::size_t cost_of_object = 6;

/// Bit per axis: the box begins in this region and not below it.
///
/// Each pair is reported in exactly one leaf. The intersection of two boxes has its lower corner at the
/// larger of their lower ends. Half-open regions cover space once, so the corner is in exactly one leaf L.
/// Both boxes touch L: along each axis and for each plane above L, if the corner is below the plane, so are
/// the lower ends of both boxes; otherwise both upper ends, which are no less than the corner, are not below
/// it. In all leaves that both boxes touch, the lower ends are below the upper sides. L is the only one of
/// them whose lower sides are all <= the corner, that is, where one of the two boxes begins along each axis.
std::uint32_t begins_in(const SceneOctree::Region& leaf, const Aabb& box) {
  return static_cast<std::uint32_t>((box.min.x >= leaf.lower.x) | (box.min.y >= leaf.lower.y) << 1 |
                                    (box.min.z >= leaf.lower.z) << 2);
}

/// Writes the slots whose boxes overlap this one to `found`, which has room for one more than all, and
/// returns their number.
std::size_t find_overlapping(const Aabb& box, std::span<const Aabb> boxes,
                             std::span<const std::uint32_t> slots, std::uint32_t* found) {
  // The boxes are far apart in memory, so all are prefetched before the first is needed.
  for (const std::uint32_t slot : slots) {
    hwy::Prefetch(&boxes[slot].min);
    hwy::Prefetch(&boxes[slot].max.z);  // perhaps in the next cache line
  }
  std::size_t count = 0;
  for (const std::uint32_t slot : slots) {
    const Aabb& other = boxes[slot];
    // No branch, because which boxes overlap is unpredictable.
    found[count] = slot;
    count += static_cast<std::size_t>((other.min.x <= box.max.x) & (other.min.y <= box.max.y) &
                                      (other.min.z <= box.max.z) & (other.max.x >= box.min.x) &
                                      (other.max.y >= box.min.y) & (other.max.z >= box.min.z));
  }
  return count;
}

}  // namespace

void OctreeSearch::search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  const std::uint64_t expanded = tree_.expanded_count(), reduced = tree_.reduced_count();
  if (volumes.revision() == revision_ + 1) {
    follow_changes(volumes, found.stats);
  } else {
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
  const auto lists = sorter_.start(parallel.worker_count(), volumes.slot_count());
  constexpr std::size_t grain = 64;
  if (few_changed) {
    is_changed_.resize(volumes.slot_count(), 0);
    for (const std::uint32_t slot : changed) is_changed_[slot] = 1;
    parallel.for_ranges(changed.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
      for (std::size_t i = begin; i < end; ++i)
        find_of_object(volumes, changed[i], workers_[worker], lists[worker]);
    });
    found.stats.objects_paired = changed.size();
    sorter_.finish(parallel, fresh_);
    erase_repeats(fresh_);
    merge_kept(found.pairs);
    for (const std::uint32_t slot : changed) is_changed_[slot] = 0;
  } else {
    const auto regions = tree_.regions();
    parallel.for_ranges(regions.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
      for (std::size_t i = begin; i < end; ++i)
        if (regions[i].in_use && regions[i].objects.count > 1)
          find_in_leaf(volumes, regions[i], workers_[worker], lists[worker]);
    });
    found.stats.objects_paired = tree_.object_count();
    sorter_.finish(parallel, found.pairs);
    erase_repeats(found.pairs);
  }
  for (const Worker& worker : workers_) found.stats.object_pairs_tested += worker.tests;
}

/// Two spheres may share several leaves, and each of them reports the pair. Boxes have no repeats.
void OctreeSearch::erase_repeats(std::vector<IndexPair>& pairs) const {
  if (tree_.placed_by_sphere()) pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

void OctreeSearch::follow_changes(const VolumeStore& volumes, BroadPhaseStats& stats) {
  crossing_.clear();
  for (const std::uint32_t slot : volumes.changed())
    if (!tree_.stays(slot, volumes.boxes()[slot])) crossing_.push_back(slot);
  stats.objects_placed = crossing_.size();
  // Moving an object costs a little more than its share of a build.
  const bool many = 4 * crossing_.size() > 3 * tree_.object_count();
  if (!many) {
    for (const std::uint32_t slot : crossing_) tree_.move(volumes, slot);
    tree_.settle(volumes);
  }
  // After as many moves as there are objects, the extent of the scene or its number of objects may differ.
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
                                PairList& pairs) const {
  const auto slots = tree_.objects(leaf);
  const auto boxes = volumes.boxes();
  const auto begins = [&](const Aabb& box) {
    return tree_.placed_by_sphere() ? std::uint32_t{7} : begins_in(leaf, box);
  };
  worker.order.clear();
  for (const std::uint32_t slot : slots) worker.order.push_back(order_key(boxes[slot].min.x, slot));
  worker.lanes.is_sorted = slots.size() >= sort_leaf_at;
  if (worker.lanes.is_sorted) std::sort(worker.order.begin(), worker.order.end());
  worker.lanes.resize(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const auto slot = static_cast<std::uint32_t>(worker.order[i]);
    worker.lanes.set(i, slot, boxes[slot], marks_of(volumes, slot, begins(boxes[slot])));
  }
  worker.tests += find_overlaps(worker.lanes, 0, slots.size(), volumes, pairs);
}

void OctreeSearch::find_of_object(const VolumeStore& volumes, std::uint32_t slot, Worker& worker,
                                  PairList& pairs) const {
  const auto boxes = volumes.boxes();
  const ObjectVolume volume = volumes.volume(slot);
  const std::size_t kind = volumes.kind(slot);
  tree_.visit_leaves(volume, [&](const SceneOctree::Region& leaf) {
    const std::uint32_t begins = tree_.placed_by_sphere() ? std::uint32_t{7} : begins_in(leaf, volume.box);
    const auto slots = tree_.objects(leaf);
    if (worker.others.size() <= slots.size()) worker.others.resize(slots.size() + 1);
    const std::size_t found = find_overlapping(volume.box, boxes, slots, worker.others.data());
    std::size_t count = 0;
    for (const std::uint32_t other : std::span(worker.others).first(found)) {
      // When both objects changed, the one with the smaller index finds the pair.
      if (other == slot || (other < slot && is_changed_[other] != 0)) continue;
      if ((begins | begins_in(leaf, boxes[other])) != 7) continue;
      if (!volumes.wanted().are_paired(kind, volumes.kind(other))) continue;
      pairs.first[count] = slot;
      pairs.second[count++] = other;
      if (count <= PairList::batch_size) continue;
      pairs.flush(count, volumes.spheres());
      count = 0;
    }
    pairs.flush(count, volumes.spheres());
    worker.tests += leaf.objects.count - 1;
  });
}

/// Merges the pairs of objects that did not change with the pairs that were found now.
void OctreeSearch::merge_kept(std::vector<IndexPair>& pairs) {
  kept_.swap(pairs);
  pairs.reserve(kept_.capacity());
  pairs.resize(kept_.size() + fresh_.size());
  IndexPair* next = pairs.data();
  auto kept = kept_.begin();
  const auto keep = [&] {
    *next = *kept++;
    next += static_cast<std::ptrdiff_t>((is_changed_[next->a] | is_changed_[next->b]) == 0);
  };
  for (const IndexPair pair : fresh_) {
    while (kept != kept_.end() && *kept < pair) keep();
    *next++ = pair;
  }
  while (kept != kept_.end()) keep();
  pairs.resize(static_cast<std::size_t>(next - pairs.data()));
}

}  // namespace supple
