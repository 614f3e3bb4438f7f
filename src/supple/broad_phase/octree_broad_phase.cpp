#include "broad_phase/octree_broad_phase.hpp"

#include <algorithm>
#include <cstring>

#include "broad_phase/float_order.hpp"
#include "broad_phase/overlap_kernel.hpp"

namespace supple {
namespace {

/// Fewer objects than this in a leaf are tested each against each: sorting them first would take longer.
constexpr std::uint32_t kSortLeafAt = 96;

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
    : bounding_volume_(bounding_volume), max_level_(options.max_level), tree_(bounding_volume, options) {}

void OctreeBroadPhase::find_pairs(const ObjectVolumes& volumes, const Parallel& parallel,
                                  std::vector<IndexPair>& pairs) {
  stats_ = {};
  const std::uint64_t expanded = tree_.expanded_count(), reduced = tree_.reduced_count();
  detect_changes(volumes, parallel);
  if (changed_.empty()) {
    pairs.assign(last_pairs_.begin(), last_pairs_.end());
    return;
  }
  update_regions(volumes);
  stats_.regions_expanded = tree_.expanded_count() - expanded;
  stats_.regions_reduced = tree_.reduced_count() - reduced;

  workers_.resize(parallel.worker_count());
  found_.resize(parallel.worker_count());
  for (Worker& worker : workers_) {
    worker.found.clear();
    worker.tests = 0;
  }
  // The search of one object costs as much as several objects' share of a search through all leaves.
  constexpr std::size_t kSearchCost = 6;
  const bool few_changed = kSearchCost * changed_.size() < live_;
  if (few_changed)
    find_of_changed(parallel);
  else
    find_all(parallel);
  for (Worker& worker : workers_) stats_.object_pairs_tested += worker.tests;

  for (std::size_t i = 0; i < workers_.size(); ++i) std::swap(found_[i], workers_[i].found);
  if (few_changed) {
    sorter_.sort(found_, tree_.slot_count(), tree_.placed_by_sphere(), parallel, fresh_);
    merge_kept(pairs);
  } else {
    sorter_.sort(found_, tree_.slot_count(), tree_.placed_by_sphere(), parallel, pairs);
  }
  last_pairs_.assign(pairs.begin(), pairs.end());
}

void OctreeBroadPhase::detect_changes(const ObjectVolumes& volumes, const Parallel& parallel) {
  const std::size_t given = slot_count(volumes, bounding_volume_);
  const std::size_t slots = std::max(given, known_slots_);
  tree_.resize(slots);
  changes_.resize(slots);
  // Most of a scene is often at rest: whole blocks of boxes are compared at once.
  const std::size_t comparable = bounding_volume_ == BoundingVolume::aabb ? std::min(given, known_slots_) : 0;
  constexpr std::size_t kBlock = 8, kGrain = 1024;
  const std::size_t blocks = (slots + kBlock - 1) / kBlock;
  parallel.for_ranges(blocks, kGrain, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t block = first; block < last; ++block) {
      const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, slots);
      const bool same = end <= comparable && std::memcmp(&volumes.boxes[begin], &tree_.boxes()[begin],
                                                         (end - begin) * sizeof(Aabb)) == 0;
      for (std::size_t i = begin; i < end; ++i) changes_[i] = same ? Change::none : take_change(volumes, i);
    }
  });
  known_slots_ = given;
  collect_changes();
}

/// Compares a volume with that of the step before, and takes it over when its object stays in its regions.
OctreeBroadPhase::Change OctreeBroadPhase::take_change(const ObjectVolumes& volumes, std::size_t i) {
  if (i < known_slots_ && i < volumes.changed.size() && volumes.changed[i] == 0) return Change::none;
  const std::uint32_t slot = static_cast<std::uint32_t>(i);
  const ObjectVolume now = volume_at(volumes, bounding_volume_, i);
  if (tree_.same_volume(slot, now)) return Change::none;
  if (!tree_.stays(slot, now)) return Change::across_regions;
  tree_.set_volume(slot, now);
  return Change::within_regions;
}

void OctreeBroadPhase::collect_changes() {
  changed_.clear();
  crossing_.clear();
  for (std::uint32_t slot = 0; slot < changes_.size(); ++slot) {
    if (changes_[slot] == Change::none) continue;
    changed_.push_back(slot);
    if (changes_[slot] == Change::across_regions) crossing_.push_back(slot);
  }
  stats_.objects_changed = changed_.size();
}

void OctreeBroadPhase::update_regions(const ObjectVolumes& volumes) {
  for (const std::uint32_t slot : crossing_) {
    live_ -= !tree_.boxes()[slot].empty();
    live_ += !volume_at(volumes, bounding_volume_, slot).empty();
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
  if (built_ && !many && placed_since_choice_ < std::max(live_, kFewPlacements)) return;
  if (crossing_.empty()) return;
  placed_since_choice_ = 0;
  const SceneCube cube = cube_chooser_.choose(tree_.boxes(), max_level_);
  if (built_ && !many && !is_outdated(tree_.cube(), cube)) return;
  tree_.build(cube);
  built_ = true;
  stats_.regions_rebuilt = 1;
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
      if (other == slot || (other < slot && changes_[other] != Change::none)) continue;
      if ((begins | begins_in(leaf, boxes[other])) == 7)
        worker.found.push({std::min(slot, other), std::max(slot, other)});
    }
    worker.tests += leaf.objects.count - 1;
  });
  if (bounding_volume_ == BoundingVolume::sphere)
    keep_overlapping_spheres(tree_.spheres(), first, worker.found);
}

/// Pairs of the last step between objects that did not change, and those found now.
void OctreeBroadPhase::merge_kept(std::vector<IndexPair>& pairs) {
  pairs.resize(last_pairs_.size() + fresh_.size());
  auto out = pairs.begin();
  auto fresh = fresh_.begin();
  for (const IndexPair pair : last_pairs_) {
    if (changes_[pair.a] != Change::none || changes_[pair.b] != Change::none) continue;
    while (fresh != fresh_.end() && *fresh < pair) *out++ = *fresh++;
    *out++ = pair;
  }
  out = std::copy(fresh, fresh_.end(), out);
  pairs.erase(out, pairs.end());
}

std::string OctreeBroadPhase::validate() const {
  if (!std::is_sorted(last_pairs_.begin(), last_pairs_.end()))
    return "scene octree: the pairs kept from the last step are not sorted";
  return tree_.validate();
}

}  // namespace supple
