#include "broad_phase/sweep/sweep_search.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "broad_phase/float_order.hpp"

namespace supple {

void SweepSearch::search(VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  volumes.take_changed();
  const auto boxes = volumes.boxes();
  choose_axis(boxes);
  update_order(boxes);
  lanes_.resize(order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto slot = static_cast<std::uint32_t>(order_[i]);
    lanes_.set(i, slot, boxes[slot], 7, axis_);
  }

  const auto bins = sorter_.start(parallel.worker_count(), boxes.size());
  std::atomic<std::uint64_t> tests = 0;
  constexpr std::size_t grain = 256;
  parallel.for_ranges(order_.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    tests += find_overlaps_sorted(lanes_, begin, end, volumes.spheres(), bins[worker]);
  });
  sorter_.finish(parallel, found.pairs);
  found.stats.object_pairs_tested = tests;
  found.stats.objects_paired = order_.size();
}

void SweepSearch::choose_axis(std::span<const Aabb> boxes) {
  std::array<double, 3> sum{}, sum_of_squares{};
  std::size_t count = 0;
  for (const Aabb& box : boxes) {
    Vec3d center;
    for (int axis = 0; axis < 3; ++axis) center[axis] = 0.5 * (double{box.min[axis]} + box.max[axis]);
    if (!std::isfinite(center.x + center.y + center.z)) continue;
    ++count;
    for (int axis = 0; axis < 3; ++axis) {
      sum[static_cast<std::size_t>(axis)] += center[axis];
      sum_of_squares[static_cast<std::size_t>(axis)] += center[axis] * center[axis];
    }
  }
  if (count == 0) return;
  std::array<double, 3> variance;
  for (std::size_t axis = 0; axis < 3; ++axis)
    variance[axis] = sum_of_squares[axis] - sum[axis] * sum[axis] / static_cast<double>(count);
  const auto widest = std::max_element(variance.begin(), variance.end());
  // The order of the step before is worth keeping when the axes differ by little.
  constexpr double worth_switching = 1.25;
  if (*widest > worth_switching * variance[static_cast<std::size_t>(axis_)])
    axis_ = static_cast<int>(widest - variance.begin());
}

/// The lower end along the axis in the upper half, the slot in the lower half.
std::uint64_t SweepSearch::key_of(std::span<const Aabb> boxes, std::uint32_t slot) const {
  return std::uint64_t{float_order(boxes[slot].min[axis_])} << 32 | slot;
}

void SweepSearch::update_order(std::span<const Aabb> boxes) {
  in_order_.resize(boxes.size(), 0);
  std::size_t kept = 0, descents = 0;
  for (const std::uint64_t old : order_) {
    const auto slot = static_cast<std::uint32_t>(old);
    in_order_[slot] = !boxes[slot].empty();
    if (in_order_[slot] == 0) continue;
    order_[kept] = key_of(boxes, slot);
    descents += kept != 0 && order_[kept] < order_[kept - 1];
    ++kept;
  }
  order_.resize(kept);
  for (std::uint32_t slot = 0; slot < boxes.size(); ++slot) {
    if (in_order_[slot] != 0 || boxes[slot].empty()) continue;
    in_order_[slot] = 1;
    order_.push_back(key_of(boxes, slot));
    ++descents;
  }
  // Insertion is fast when little is out of order, and quadratic at worst.
  if (descents > order_.size() / 32 || !insert_in_order()) std::sort(order_.begin(), order_.end());
}

/// Returns false, with the order incomplete, after a few moves for each box.
bool SweepSearch::insert_in_order() {
  std::size_t moves_left = 4 * order_.size();
  for (std::size_t i = 1; i < order_.size(); ++i) {
    const std::uint64_t key = order_[i];
    std::size_t hole = i;
    for (; hole != 0 && key < order_[hole - 1] && moves_left != 0; --hole, --moves_left)
      order_[hole] = order_[hole - 1];
    order_[hole] = key;
    if (moves_left == 0) return false;
  }
  return true;
}

std::string SweepSearch::validate(const VolumeStore& volumes) const {
  const auto boxes = volumes.boxes();
  std::size_t live = 0;
  for (const Aabb& box : boxes) live += !box.empty();
  if (order_.size() != live)
    return "sweep: the order has " + std::to_string(order_.size()) + " boxes of " + std::to_string(live);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto slot = static_cast<std::uint32_t>(order_[i]);
    if (slot >= boxes.size() || boxes[slot].empty() || order_[i] != key_of(boxes, slot))
      return "sweep: slot " + std::to_string(slot) + " is empty or has a stale position";
    if (i != 0 && order_[i] <= order_[i - 1]) return "sweep: the order falls at place " + std::to_string(i);
  }
  return {};
}

}  // namespace supple
