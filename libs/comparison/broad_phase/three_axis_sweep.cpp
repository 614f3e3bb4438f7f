#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

#include "comparison/methods.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"

namespace supple {
namespace {

IndexPair pair_of(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

void ThreeAxisSweep::search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  const std::span<const Aabb> boxes = volumes.boxes();
  is_listed_.resize(boxes.size(), 0);
  for (Axis& axis : axes_) axis.exchanges = axis.tests = 0;
  const bool same_boxes = std::ranges::all_of(
      volumes.changed(), [&](std::uint32_t slot) { return (is_listed_[slot] != 0) != boxes[slot].empty(); });
  if (same_boxes) {
    parallel.for_ranges(axes_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t axis = begin; axis < end; ++axis)
        sort_by_insertion(axes_[axis], static_cast<int>(axis), boxes);
    });
    update_box_pairs();
    found.stats.objects_paired = static_cast<std::uint64_t>(
        std::ranges::count_if(volumes.changed(), [&](std::uint32_t slot) { return is_listed_[slot] != 0; }));
  } else {
    start(boxes);
    found.stats.objects_paired = axes_[0].ends.size() / 2;
  }
  for (const Axis& axis : axes_) {
    found.stats.exchanges += axis.exchanges;
    found.stats.object_pairs_tested += axis.tests;
  }
  report(volumes, found);
}

void ThreeAxisSweep::start(std::span<const Aabb> boxes) {
  for (std::uint32_t slot = 0; slot < boxes.size(); ++slot) is_listed_[slot] = boxes[slot].empty() ? 0 : 1;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<End>& ends = axes_[static_cast<std::size_t>(axis)].ends;
    ends.clear();
    for (std::uint32_t slot = 0; slot < boxes.size(); ++slot) {
      if (is_listed_[slot] == 0) continue;
      ends.push_back({boxes[slot].min[axis], slot, false});
      ends.push_back({boxes[slot].max[axis], slot, true});
    }
    std::sort(ends.begin(), ends.end());
  }
  box_pairs_.clear();
  open_.clear();
  for (const End& end : axes_[0].ends) {
    if (end.is_upper) {
      open_.erase(std::ranges::find(open_, end.slot));
      continue;
    }
    for (const std::uint32_t other : open_) {
      if (overlap(boxes[end.slot], boxes[other])) box_pairs_.push_back(pair_of(end.slot, other));
    }
    axes_[0].tests += open_.size();
    open_.push_back(end.slot);
  }
  std::sort(box_pairs_.begin(), box_pairs_.end());
}

/// Two ends are exchanged when their order differs from that of the step before, once along each axis. A pair
/// can begin only where a lower end goes below an upper one, and it ends where an upper end does the reverse.
void ThreeAxisSweep::sort_by_insertion(Axis& axis, int k, std::span<const Aabb> boxes) const {
  const std::span<End> ends = axis.ends;
  axis.begun.clear();
  axis.ended.clear();
  for (End& end : ends) end.value = (end.is_upper ? boxes[end.slot].max : boxes[end.slot].min)[k];
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const End moving = ends[i];
    std::size_t to = i;
    for (; to > 0 && moving < ends[to - 1]; --to) {
      const End passed = ends[to - 1];
      ends[to] = passed;
      if (moving.is_upper == passed.is_upper) continue;
      const IndexPair pair = pair_of(moving.slot, passed.slot);
      if (moving.is_upper) {
        const auto place = std::lower_bound(box_pairs_.begin(), box_pairs_.end(), pair);
        if (place != box_pairs_.end() && *place == pair)
          axis.ended.push_back(static_cast<std::size_t>(place - box_pairs_.begin()));
      } else {
        ++axis.tests;
        if (overlap(boxes[pair.a], boxes[pair.b])) axis.begun.push_back(pair);
      }
    }
    ends[to] = moving;
    axis.exchanges += i - to;
  }
}

void ThreeAxisSweep::update_box_pairs() {
  has_ended_.assign(box_pairs_.size(), 0);
  begun_.clear();
  for (const Axis& axis : axes_) {
    begun_.insert(begun_.end(), axis.begun.begin(), axis.begun.end());
    for (const std::size_t place : axis.ended) has_ended_[place] = 1;
  }
  std::sort(begun_.begin(), begun_.end());
  begun_.erase(std::unique(begun_.begin(), begun_.end()), begun_.end());
  merged_.clear();
  auto next = begun_.begin();
  for (std::size_t i = 0; i < box_pairs_.size(); ++i) {
    if (has_ended_[i] != 0) continue;
    for (; next != begun_.end() && *next < box_pairs_[i]; ++next) merged_.push_back(*next);
    merged_.push_back(box_pairs_[i]);
  }
  merged_.insert(merged_.end(), next, begun_.end());
  box_pairs_.swap(merged_);
}

/// Lists the pairs of wanted kinds whose boxes overlap and, with spheres, whose spheres overlap.
void ThreeAxisSweep::report(const VolumeStore& volumes, FoundPairs& found) const {
  const std::span<const BoundingSphere> spheres = volumes.spheres();
  found.pairs.clear();
  for (const IndexPair& pair : box_pairs_) {
    if (!volumes.wanted().are_paired(volumes.kind(pair.a), volumes.kind(pair.b))) continue;
    found.stats.object_pairs_tested += spheres.empty() ? 0 : 1;
    if (spheres.empty() || overlap(spheres[pair.a], spheres[pair.b])) found.pairs.push_back(pair);
  }
}

}  // namespace supple
