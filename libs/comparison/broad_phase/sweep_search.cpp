#include "comparison/methods.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace supple {
namespace {

/// The axis along which the centres have the largest variance.
int widest_axis(std::span<const Aabb> boxes) {
  std::array<double, 3> sum{}, sum_of_squares{}, variance{};
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
  for (std::size_t axis = 0; axis < 3 && count != 0; ++axis)
    variance[axis] = sum_of_squares[axis] - sum[axis] * sum[axis] / static_cast<double>(count);
  return static_cast<int>(std::max_element(variance.begin(), variance.end()) - variance.begin());
}

}  // namespace

void SweepSearch::search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  const auto boxes = volumes.boxes();
  const int axis = sorts_ ? widest_axis(boxes) : 0;
  order_.clear();
  for (std::uint32_t slot = 0; slot < boxes.size(); ++slot)
    if (!boxes[slot].empty()) order_.push_back(order_key(boxes[slot].min[axis], slot));
  if (sorts_) std::sort(order_.begin(), order_.end());
  lanes_.resize(order_.size());
  lanes_.is_sorted = sorts_;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto slot = static_cast<std::uint32_t>(order_[i]);
    lanes_.set(i, slot, boxes[slot], marks_of(volumes, slot), axis);
  }

  const auto lists = sorter_.start(parallel.worker_count(), boxes.size());
  std::atomic<std::uint64_t> tests = 0;
  constexpr std::size_t grain = 64;
  parallel.for_ranges(order_.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    tests += find_overlaps(lanes_, begin, end, volumes, lists[worker]);
  });
  sorter_.finish(parallel, found.pairs);
  found.stats.object_pairs_tested = tests;
  found.stats.objects_paired = order_.size();
}

}  // namespace supple
