#include "broad_phase/octree_broad_phase.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "broad_phase/float_order.hpp"
#include "broad_phase/overlap_kernel.hpp"

namespace supple {
namespace {

/// Fewer objects than this in a leaf are tested each against each: sorting them first would take longer.
constexpr std::uint32_t kSortLeafAt = 96;

/// The search of one object costs as much as several objects' share of a search for all.
constexpr std::size_t kSearchCost = 6;

/// Regions are made again after so many frames in a row in which few objects changed: one such frame among
/// others does not pay for them.
constexpr std::size_t kFramesWorthRegions = 4;

bool is_changed(const Aabb& now, const Aabb& before) {
  return std::memcmp(&now, &before, sizeof now) != 0 && !(now.empty() && before.empty());
}

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

OctreeBroadPhase::OctreeBroadPhase(BoundingVolume bounding_volume, const SceneOctreeOptions& options)
    : bounding_volume_(bounding_volume),
      always_regions_(options.always_regions),
      max_level_(options.max_level),
      tree_(bounding_volume, options) {}

std::span<const IndexPair> OctreeBroadPhase::find_pairs(const ObjectVolumes& volumes,
                                                        const Parallel& parallel) {
  stats_ = {};
  detect_changes(volumes, parallel);
  if (stats_.objects_changed == 0) return pairs_;
  workers_.resize(parallel.worker_count());
  found_.resize(parallel.worker_count());
  for (Worker& worker : workers_) {
    worker.found.clear();
    worker.tests = 0;
  }
  const bool few_changed = kSearchCost * stats_.objects_changed < live_;
  if (few_changed) ++frames_of_few_;
  if (!few_changed && has_regions_ever_ && !always_regions_) {
    frames_of_few_ = 0;
    search_in_bulk(volumes, parallel);
  } else if (few_changed && !has_regions_ && frames_of_few_ < kFramesWorthRegions) {
    search_in_bulk(volumes, parallel);
  } else {
    search_regions(volumes, parallel, few_changed);
  }
  return pairs_;
}

/// By the regions, which follow the objects first.
void OctreeBroadPhase::search_regions(const ObjectVolumes& volumes, const Parallel& parallel,
                                      bool few_changed) {
  const std::uint64_t expanded = tree_.expanded_count(), reduced = tree_.reduced_count();
  collect_changes();
  if (has_regions_) {
    follow_changes(volumes);
  } else {
    tree_.set_volumes(volumes);
    make_regions();
  }
  stats_.regions_expanded = tree_.expanded_count() - expanded;
  stats_.regions_reduced = tree_.reduced_count() - reduced;
  if (few_changed)
    find_of_changed(parallel);
  else
    find_all(parallel);
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    stats_.object_pairs_tested += workers_[i].tests;
    std::swap(found_[i], workers_[i].found);
  }
  sorter_.sort(found_, tree_.slot_count(), tree_.placed_by_sphere(), parallel, few_changed ? fresh_ : pairs_);
  if (few_changed) merge_kept();
}

/// Anew, without regions; they fall behind until they are worth being made again.
void OctreeBroadPhase::search_in_bulk(const ObjectVolumes& volumes, const Parallel& parallel) {
  has_regions_ = false;
  tree_.set_volumes(volumes);
  const auto bins = sorter_.start(parallel.worker_count(), tree_.slot_count());
  if (!bulk_.find(tree_.boxes(), tree_.spheres(), parallel, pairs_.size(), bins))
    return search_regions(volumes, parallel, false);
  sorter_.finish(false, parallel, pairs_);
  live_ = stats_.objects_paired = bulk_.box_count();
  stats_.object_pairs_tested = bulk_.tests();
}

void OctreeBroadPhase::detect_changes(const ObjectVolumes& volumes, const Parallel& parallel) {
  const std::size_t given = slot_count(volumes, bounding_volume_);
  const std::size_t slots = std::max(given, known_slots_);
  tree_.resize(slots);
  is_changed_.resize(slots);
  std::atomic<std::size_t> changed = 0;
  constexpr std::size_t kGrain = 8192;
  parallel.for_ranges(slots, kGrain, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    changed += detect_changes_in(volumes, begin, end);
  });
  known_slots_ = given;
  stats_.objects_changed = changed;
}

std::size_t OctreeBroadPhase::detect_changes_in(const ObjectVolumes& volumes, std::size_t begin,
                                                std::size_t end) {
  // Most of a scene is often at rest: whole blocks of boxes are compared at once.
  constexpr std::size_t kBlock = 8;
  const bool by_box = bounding_volume_ == BoundingVolume::aabb;
  const std::size_t comparable = by_box ? std::min(volumes.boxes.size(), known_slots_) : 0;
  const Aabb* const now = volumes.boxes.data();
  const Aabb* const before = tree_.boxes().data();
  std::size_t changed = 0;
  for (std::size_t i = begin; i < end;) {
    const std::size_t block_end = std::min(i + kBlock, end);
    if (block_end > comparable || !volumes.changed.empty()) {
      for (; i < block_end; ++i) changed += is_changed_[i] = is_changed(volumes, i);
    } else if (std::memcmp(now + i, before + i, (block_end - i) * sizeof(Aabb)) == 0) {
      for (; i < block_end; ++i) is_changed_[i] = 0;
    } else {
      for (; i < block_end; ++i) changed += is_changed_[i] = supple::is_changed(now[i], before[i]);
    }
  }
  return changed;
}

bool OctreeBroadPhase::is_changed(const ObjectVolumes& volumes, std::size_t i) const {
  if (i < known_slots_ && i < volumes.changed.size() && volumes.changed[i] == 0) return false;
  return !tree_.same_volume(static_cast<std::uint32_t>(i), volume_at(volumes, bounding_volume_, i));
}

void OctreeBroadPhase::collect_changes() {
  changed_.clear();
  for (std::size_t i = 0; i < is_changed_.size(); ++i)
    if (is_changed_[i] != 0) changed_.push_back(static_cast<std::uint32_t>(i));
}

/// Objects that stay in their regions only have their volumes taken over.
void OctreeBroadPhase::follow_changes(const ObjectVolumes& volumes) {
  crossing_.clear();
  for (const std::uint32_t slot : changed_) {
    const ObjectVolume now = volume_at(volumes, bounding_volume_, slot);
    if (tree_.stays(slot, now)) {
      tree_.set_volume(slot, now);
      continue;
    }
    crossing_.push_back(slot);
    live_ -= !tree_.boxes()[slot].empty();
    live_ += !now.empty();
  }
  // Placing an object again costs a little more than its share of a build.
  const bool many = 4 * crossing_.size() > 3 * live_;
  for (const std::uint32_t slot : crossing_) {
    const ObjectVolume now = volume_at(volumes, bounding_volume_, slot);
    if (many)
      tree_.set_volume(slot, now);
    else
      tree_.move(slot, now);
  }
  tree_.settle();
  placed_since_choice_ += crossing_.size();
  stats_.objects_placed = crossing_.size();

  // When all objects have been placed once more the scene may be another, in extent or in number.
  constexpr std::size_t kFewPlacements = 64;
  if (!many && placed_since_choice_ < std::max(live_, kFewPlacements)) return;
  if (crossing_.empty()) return;
  placed_since_choice_ = 0;
  const SceneCube cube = cube_chooser_.choose(tree_.boxes(), max_level_);
  if (!many && !is_outdated(tree_.cube(), cube)) return;
  tree_.build(cube);
  stats_.regions_rebuilt = 1;
}

void OctreeBroadPhase::make_regions() {
  tree_.build(cube_chooser_.choose(tree_.boxes(), max_level_));
  has_regions_ = has_regions_ever_ = true;
  placed_since_choice_ = 0;
  live_ = 0;
  for (const Aabb& box : tree_.boxes()) live_ += !box.empty();
  stats_.objects_placed = live_;
  stats_.regions_rebuilt = 1;
}

std::vector<SceneRegion> OctreeBroadPhase::regions() const {
  return has_regions_ ? tree_.describe() : present_regions().describe();
}

/// Those that would be made of the objects' present volumes.
SceneOctree OctreeBroadPhase::present_regions() const {
  SceneOctree tree = tree_;
  SceneCubeChooser chooser;
  tree.build(chooser.choose(tree.boxes(), max_level_));
  return tree;
}

void OctreeBroadPhase::find_all(const Parallel& parallel) {
  stats_.objects_paired = live_;
  constexpr std::size_t kGrain = 64;
  const auto regions = tree_.regions();
  parallel.for_ranges(regions.size(), kGrain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end; ++i)
      if (regions[i].in_use && regions[i].objects.count > 1) find_in_leaf(regions[i], workers_[worker]);
  });
}

void OctreeBroadPhase::find_in_leaf(const SceneOctree::Region& leaf, Worker& worker) const {
  const auto slots = tree_.objects(leaf);
  const auto boxes = tree_.boxes();
  const auto begins = [&](const Aabb& box) {
    return tree_.placed_by_sphere() ? std::uint32_t{7} : begins_in(leaf, box);
  };
  const std::size_t first = worker.found.size();
  worker.lanes.resize(slots.size());
  if (slots.size() < kSortLeafAt) {
    for (std::size_t i = 0; i < slots.size(); ++i)
      worker.lanes.set(i, slots[i], boxes[slots[i]], begins(boxes[slots[i]]));
    worker.tests += find_overlaps(worker.lanes, 0, slots.size(), worker.found);
  } else {
    worker.order.clear();
    for (const std::uint32_t slot : slots)
      worker.order.push_back(std::uint64_t{float_order(boxes[slot].min.x)} << 32 | slot);
    std::sort(worker.order.begin(), worker.order.end());
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const auto slot = static_cast<std::uint32_t>(worker.order[i]);
      worker.lanes.set(i, slot, boxes[slot], begins(boxes[slot]));
    }
    worker.tests += find_overlaps_sorted(worker.lanes, 0, slots.size(), worker.found);
  }
  if (bounding_volume_ == BoundingVolume::sphere)
    keep_overlapping_spheres(tree_.spheres(), first, worker.found);
}

void OctreeBroadPhase::find_of_changed(const Parallel& parallel) {
  stats_.objects_paired = changed_.size();
  constexpr std::size_t kGrain = 64;
  parallel.for_ranges(changed_.size(), kGrain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end; ++i) find_of_object(changed_[i], workers_[worker]);
  });
}

void OctreeBroadPhase::find_of_object(std::uint32_t slot, Worker& worker) const {
  const auto boxes = tree_.boxes();
  const Aabb box = boxes[slot];
  const std::size_t first = worker.found.size();
  tree_.visit_leaves(slot, [&](const SceneOctree::Region& leaf) {
    const std::uint32_t begins = tree_.placed_by_sphere() ? std::uint32_t{7} : begins_in(leaf, box);
    find_overlaps_of(box, boxes, tree_.objects(leaf), worker.others);
    for (const std::uint32_t other : worker.others) {
      // Of two that changed, the one with the smaller index finds the pair.
      if (other == slot || (other < slot && is_changed_[other] != 0)) continue;
      if ((begins | begins_in(leaf, boxes[other])) == 7)
        worker.found.push({std::min(slot, other), std::max(slot, other)});
    }
    worker.tests += leaf.objects.count - 1;
  });
  if (bounding_volume_ == BoundingVolume::sphere)
    keep_overlapping_spheres(tree_.spheres(), first, worker.found);
}

/// Pairs of the last step between objects that did not change, and those found now.
void OctreeBroadPhase::merge_kept() {
  last_pairs_.swap(pairs_);
  pairs_.resize(last_pairs_.size() + fresh_.size());
  auto out = pairs_.begin();
  auto fresh = fresh_.begin();
  for (const IndexPair pair : last_pairs_) {
    if (is_changed_[pair.a] != 0 || is_changed_[pair.b] != 0) continue;
    while (fresh != fresh_.end() && *fresh < pair) *out++ = *fresh++;
    *out++ = pair;
  }
  out = std::copy(fresh, fresh_.end(), out);
  pairs_.erase(out, pairs_.end());
}

std::string OctreeBroadPhase::validate() const {
  if (!std::is_sorted(pairs_.begin(), pairs_.end()))
    return "scene octree: the pairs kept from the last step are not sorted";
  return has_regions_ ? tree_.validate() : present_regions().validate();
}

}  // namespace supple
