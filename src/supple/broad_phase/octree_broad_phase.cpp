#include "broad_phase/octree_broad_phase.hpp"

#include <hwy/cache_control.h>

#include <algorithm>

#include "broad_phase/change_kernel.hpp"
#include "broad_phase/float_order.hpp"
#include "broad_phase/move_kernel.hpp"
#include "broad_phase/overlap_kernel.hpp"

namespace supple {
namespace {

/// Fewer objects than this in a leaf are tested each against each: sorting them first would take longer.
constexpr std::uint32_t kSortLeafAt = 96;

/// The search of one object costs as much as several objects' share of a search for all.
constexpr std::size_t kSearchCost = 6;

/// Boxes are dealt out anew after so many tests for each of them: by then they have moved about, and dealing
/// costs little against the tests.
constexpr std::int64_t kTestsPerDeal = 256;

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
  if (did_most_change(volumes)) {
    search_in_bulk(volumes, parallel, {volumes.boxes, tree_.mutable_boxes().data()});
    return pairs_;
  }
  detect_changes(volumes, parallel);
  stats_.objects_changed = changed_.size();
  if (changed_.empty()) return pairs_;
  const bool few_changed = kSearchCost * changed_.size() < live_;
  if (always_regions_ || (few_changed && basis_ == Basis::regions)) {
    search_regions(volumes, parallel, few_changed);
  } else if (!few_changed || !move_in_cells(volumes)) {
    take_over(volumes);
    search_in_bulk(volumes, parallel);
  }
  return pairs_;
}

/// By the regions, which follow the objects first.
void OctreeBroadPhase::search_regions(const ObjectVolumes& volumes, const Parallel& parallel,
                                      bool few_changed) {
  workers_.resize(parallel.worker_count());
  found_.resize(parallel.worker_count());
  for (Worker& worker : workers_) {
    worker.found.clear();
    worker.tests = 0;
  }
  const std::uint64_t expanded = tree_.expanded_count(), reduced = tree_.reduced_count();
  if (basis_ == Basis::regions) {
    follow_changes(volumes);
  } else {
    take_over(volumes);
    make_regions();
  }
  stats_.regions_expanded = tree_.expanded_count() - expanded;
  stats_.regions_reduced = tree_.reduced_count() - reduced;
  if (few_changed) {
    is_changed_.resize(tree_.slot_count(), 0);
    for (const std::uint32_t slot : changed_) is_changed_[slot] = 1;
    find_of_changed(parallel);
  } else {
    find_all(parallel);
  }
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    stats_.object_pairs_tested += workers_[i].tests;
    std::swap(found_[i], workers_[i].found);
  }
  sorter_.sort(found_, tree_.slot_count(), tree_.placed_by_sphere(), parallel, few_changed ? fresh_ : pairs_);
  if (!few_changed) return;
  merge_kept();
  for (const std::uint32_t slot : changed_) is_changed_[slot] = 0;
}

/// Judged by some of many boxes. A search in bulk is right whatever the others did, and needs no list of
/// them.
bool OctreeBroadPhase::did_most_change(const ObjectVolumes& volumes) const {
  constexpr std::size_t kMany = 1 << 14, kJudged = 64;
  const std::size_t count = volumes.boxes.size();
  if (bounding_volume_ != BoundingVolume::aabb || volumes.changed || count != known_slots_ || count < kMany)
    return false;
  if (count != tree_.slot_count() || always_regions_ || basis_ == Basis::regions) return false;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < kJudged; ++i)
    changed += static_cast<std::size_t>(is_changed(volumes, count * i / kJudged));
  return 2 * changed > kJudged;
}

/// Anew, without regions, which fall behind, unless the scene is too crowded for this.
void OctreeBroadPhase::search_in_bulk(const ObjectVolumes& volumes, const Parallel& parallel,
                                      const IncomingBoxes& incoming) {
  basis_ = Basis::nothing;
  const auto bins = sorter_.start(parallel.worker_count(), tree_.slot_count());
  const bool found = bulk_.find(tree_.boxes(), tree_.spheres(), parallel, pairs_.size(), bins, incoming);
  if (!incoming.from.empty()) stats_.objects_changed = bulk_.changed();
  if (!found) return search_regions(volumes, parallel, false);
  sorter_.finish(false, parallel, pairs_);
  basis_ = Basis::bulk;
  live_ = stats_.objects_paired = bulk_.box_count();
  stats_.object_pairs_tested = bulk_.tests();
}

/// Of few objects, in the cells of the last search in bulk, or false when there are none or they are used up.
bool OctreeBroadPhase::move_in_cells(const ObjectVolumes& volumes) {
  if (basis_ == Basis::bulk) {
    cells_.fill(bulk_.measure(), bulk_.dealt());
    tests_left_ = kTestsPerDeal * static_cast<std::int64_t>(live_ + 1);
    basis_ = Basis::cells;
  }
  if (basis_ != Basis::cells) return false;
  moved_boxes_.clear();
  moved_spheres_.clear();
  for (const std::uint32_t slot : changed_) {
    const ObjectVolume now = volume_at(volumes, bounding_volume_, slot);
    live_ -= !tree_.boxes()[slot].empty();
    live_ += !now.empty();
    moved_boxes_.push_back(now.box);
    if (bounding_volume_ == BoundingVolume::sphere) moved_spheres_.push_back(now.sphere);
  }
  toggled_.clear();
  const std::int64_t tests = tests_left_;
  if (!move_boxes(cells_, {changed_, moved_boxes_, moved_spheres_}, tree_.mutable_boxes(),
                  tree_.mutable_spheres(), tests_left_, toggled_))
    return false;
  patch_.toggle(toggled_, pairs_);
  stats_.objects_paired = changed_.size();
  stats_.object_pairs_tested = static_cast<std::uint64_t>(tests - tests_left_);
  return true;
}

void OctreeBroadPhase::detect_changes(const ObjectVolumes& volumes, const Parallel& parallel) {
  const std::size_t given = slot_count(volumes, bounding_volume_);
  const std::size_t slots = std::max(given, known_slots_);
  tree_.resize(slots);
  if (volumes.changed)
    take_told(volumes);
  else
    compare_all(volumes, parallel);
  known_slots_ = given;
}

/// Those that the caller says, and slots that are new or gone.
void OctreeBroadPhase::take_told(const ObjectVolumes& volumes) {
  const std::size_t given = slot_count(volumes, bounding_volume_);
  listed_.assign(volumes.changed->begin(), volumes.changed->end());
  for (std::size_t slot = std::min(given, known_slots_); slot < std::max(given, known_slots_); ++slot)
    listed_.push_back(static_cast<std::uint32_t>(slot));
  if (!std::is_sorted(listed_.begin(), listed_.end())) std::sort(listed_.begin(), listed_.end());
  listed_.erase(std::unique(listed_.begin(), listed_.end()), listed_.end());
  // They lie apart in memory.
  constexpr std::size_t kFetchAhead = 16;
  std::size_t count = 0;
  for (std::size_t i = 0; i < listed_.size(); ++i) {
    const std::uint32_t ahead = listed_[std::min(i + kFetchAhead, listed_.size() - 1)];
    hwy::Prefetch(tree_.boxes().data() + ahead);
    if (ahead < volumes.boxes.size()) hwy::Prefetch(volumes.boxes.data() + ahead);
    listed_[count] = listed_[i];
    count += static_cast<std::size_t>(is_changed(volumes, listed_[i]));
  }
  changed_ = {listed_.data(), count};
}

void OctreeBroadPhase::compare_all(const ObjectVolumes& volumes, const Parallel& parallel) {
  constexpr std::size_t kChunk = 8192;
  const std::size_t slots = tree_.slot_count(), chunk_count = (slots + kChunk - 1) / kChunk;
  if (listed_.size() < slots) listed_.resize(slots);
  chunk_sizes_.resize(chunk_count);
  parallel.for_ranges(chunk_count, 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t chunk = first; chunk < last; ++chunk) {
      const std::size_t begin = chunk * kChunk;
      chunk_sizes_[chunk] =
          list_changed(volumes, begin, std::min(begin + kChunk, slots), listed_.data() + begin);
    }
  });
  std::size_t count = 0;
  for (std::size_t chunk = 0; chunk < chunk_count; ++chunk) {
    std::copy_n(listed_.data() + chunk * kChunk, chunk_sizes_[chunk], listed_.data() + count);
    count += chunk_sizes_[chunk];
  }
  changed_ = {listed_.data(), count};
}

std::size_t OctreeBroadPhase::list_changed(const ObjectVolumes& volumes, std::size_t begin, std::size_t end,
                                           std::uint32_t* out) const {
  const bool by_box = bounding_volume_ == BoundingVolume::aabb;
  const std::size_t comparable = by_box ? std::min(volumes.boxes.size(), known_slots_) : 0;
  std::size_t count = 0;
  if (begin < comparable) {
    const std::size_t last = std::min(end, comparable);
    count = list_changed_boxes(volumes.boxes.data(), tree_.boxes().data(), begin, last, out);
    begin = last;
  }
  for (std::size_t i = begin; i < end; ++i)
    if (is_changed(volumes, i)) out[count++] = static_cast<std::uint32_t>(i);
  return count;
}

bool OctreeBroadPhase::is_changed(const ObjectVolumes& volumes, std::size_t i) const {
  return !tree_.same_volume(static_cast<std::uint32_t>(i), volume_at(volumes, bounding_volume_, i));
}

/// The volumes that changed, when it does not matter what regions or cells hold.
void OctreeBroadPhase::take_over(const ObjectVolumes& volumes) {
  if (!volumes.changed) return tree_.set_volumes(volumes);
  for (const std::uint32_t slot : changed_)
    tree_.set_volume(slot, volume_at(volumes, bounding_volume_, slot));
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
  basis_ = Basis::regions;
  placed_since_choice_ = 0;
  live_ = 0;
  for (const Aabb& box : tree_.boxes()) live_ += !box.empty();
  stats_.objects_placed = live_;
  stats_.regions_rebuilt = 1;
}

std::vector<SceneRegion> OctreeBroadPhase::regions() const {
  return basis_ == Basis::regions ? tree_.describe() : present_regions().describe();
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
  if (basis_ == Basis::cells) return cells_.validate(tree_.boxes());
  return basis_ == Basis::regions ? tree_.validate() : std::string();
}

}  // namespace supple
