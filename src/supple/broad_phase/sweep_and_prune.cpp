#include "broad_phase/sweep_and_prune.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "broad_phase/float_order.hpp"
#include "broad_phase/object_volume.hpp"
#include "broad_phase/overlap_kernel.hpp"

namespace supple {

std::span<const IndexPair> SweepAndPrune::find_pairs(const ObjectVolumes& volumes, const Parallel& parallel) {
  take_volumes(volumes);
  choose_axis();
  update_order();
  lanes_.resize(order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i)
    lanes_.set(i, order_[i].slot, boxes_[order_[i].slot], 7, axis_);

  found_.resize(parallel.worker_count());
  for (PairBuffer& found : found_) found.clear();
  std::atomic<std::uint64_t> tests = 0;
  constexpr std::size_t kGrain = 256;
  parallel.for_ranges(order_.size(), kGrain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    const std::size_t first = found_[worker].size();
    tests += find_overlaps_sorted(lanes_, begin, end, found_[worker]);
    if (bounding_volume_ == BoundingVolume::sphere)
      keep_overlapping_spheres(volumes.spheres, first, found_[worker]);
  });
  sorter_.sort(found_, boxes_.size(), false, parallel, pairs_);
  stats_ = {};
  stats_.object_pairs_tested = tests;
  stats_.objects_changed = stats_.objects_paired = order_.size();
  return pairs_;
}

void SweepAndPrune::take_volumes(const ObjectVolumes& volumes) {
  boxes_.resize(slot_count(volumes, bounding_volume_));
  for (std::size_t slot = 0; slot < boxes_.size(); ++slot)
    boxes_[slot] = volume_at(volumes, bounding_volume_, slot).box;
}

void SweepAndPrune::choose_axis() {
  std::array<double, 3> sum{}, sum_of_squares{};
  std::size_t count = 0;
  for (const Aabb& box : boxes_) {
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
  constexpr double kWorthSwitching = 1.25;
  if (*widest > kWorthSwitching * variance[static_cast<std::size_t>(axis_)])
    axis_ = static_cast<int>(widest - variance.begin());
}

void SweepAndPrune::update_order() {
  in_order_.resize(boxes_.size(), 0);
  std::size_t kept = 0, descents = 0;
  for (const Begin& old : order_) {
    if (old.slot >= boxes_.size()) continue;
    if (boxes_[old.slot].empty()) {
      in_order_[old.slot] = 0;
      continue;
    }
    order_[kept] = {float_order(boxes_[old.slot].min[axis_]), old.slot};
    descents += kept != 0 && order_[kept].position < order_[kept - 1].position;
    ++kept;
  }
  order_.resize(kept);
  for (std::uint32_t slot = 0; slot < boxes_.size(); ++slot) {
    if (in_order_[slot] != 0 || boxes_[slot].empty()) continue;
    in_order_[slot] = 1;
    order_.push_back({float_order(boxes_[slot].min[axis_]), slot});
    ++descents;
  }

  // Insertion moves nothing that is in place, but is quadratic at worst: past a few moves a box, sort afresh.
  if (descents > order_.size() / 32) return sort_order();
  std::size_t moves_left = 4 * order_.size();
  for (std::size_t i = 1; i < order_.size(); ++i) {
    const Begin begin = order_[i];
    std::size_t hole = i;
    for (; hole != 0 && begin.position < order_[hole - 1].position && moves_left != 0; --hole, --moves_left)
      order_[hole] = order_[hole - 1];
    order_[hole] = begin;
    if (moves_left == 0) return sort_order();
  }
}

/// Least significant digit first, eleven bits at a time.
void SweepAndPrune::sort_order() {
  constexpr std::uint32_t kBits = 11;
  constexpr std::uint32_t kDigits = 1u << kBits;
  scratch_.resize(order_.size());
  for (std::uint32_t shift = 0; shift < 32; shift += kBits) {
    std::array<std::size_t, kDigits + 1> next{};
    for (const Begin& begin : order_) ++next[((begin.position >> shift) & (kDigits - 1)) + 1];
    for (std::size_t digit = 0; digit < kDigits; ++digit) next[digit + 1] += next[digit];
    for (const Begin& begin : order_) scratch_[next[(begin.position >> shift) & (kDigits - 1)]++] = begin;
    order_.swap(scratch_);
  }
}

std::string SweepAndPrune::validate() const {
  std::vector<std::uint8_t> seen(boxes_.size(), 0);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Begin& begin = order_[i];
    if (begin.slot >= boxes_.size() || seen[begin.slot] != 0 || boxes_[begin.slot].empty())
      return "sweep: slot " + std::to_string(begin.slot) + " is in the order twice or is empty";
    seen[begin.slot] = 1;
    if (begin.position != float_order(boxes_[begin.slot].min[axis_]))
      return "sweep: slot " + std::to_string(begin.slot) + " has a stale position";
    if (i != 0 && begin.position < order_[i - 1].position)
      return "sweep: the order falls at place " + std::to_string(i);
  }
  for (std::size_t slot = 0; slot < boxes_.size(); ++slot)
    if ((seen[slot] != 0) == boxes_[slot].empty() || seen[slot] != in_order_[slot])
      return "sweep: slot " + std::to_string(slot) + " is missing from the order";
  return {};
}

}  // namespace supple
