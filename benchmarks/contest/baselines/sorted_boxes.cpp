#include "contest/baselines/sorted_boxes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace supple::benchmarks {
namespace {

/// A key whose unsigned order is the order of the floats.
std::uint32_t key_of(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

}  // namespace

std::span<const std::uint32_t> RadixSorter::sort(std::span<const Aabb> boxes, int axis) {
  constexpr int bits = 11, passes = 3;
  constexpr std::uint32_t buckets = 1u << bits, mask = buckets - 1;
  std::array<std::array<std::uint32_t, buckets>, passes> starts{};
  entries_.resize(boxes.size());
  other_.resize(boxes.size());
  order_.resize(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const std::uint32_t key = key_of(boxes[i].min[axis]);
    entries_[i] = {key, i};
    for (int pass = 0; pass < passes; ++pass) ++starts[pass][key >> (bits * pass) & mask];
  }
  for (int pass = 0; pass < passes; ++pass) {
    std::uint32_t sum = 0;
    for (std::uint32_t& start : starts[pass]) {
      const std::uint32_t count = start;
      start = sum;
      sum += count;
    }
    for (const Entry& entry : entries_) other_[starts[pass][entry.key >> (bits * pass) & mask]++] = entry;
    entries_.swap(other_);
  }
  for (std::size_t i = 0; i < entries_.size(); ++i) order_[i] = entries_[i].number;
  return order_;
}

BoxSpread spread_of(std::span<const Aabb> boxes) {
  BoxSpread spread;
  // A sample of some thousand boxes is enough.
  const std::size_t stride = boxes.size() / 4096 + 1;
  Vec3d sum, squares;
  std::size_t count = 0;
  for (std::size_t i = 0; i < boxes.size(); i += stride, ++count) {
    for (int axis = 0; axis < 3; ++axis) {
      const double low = boxes[i].min[axis], high = boxes[i].max[axis], center = 0.5 * (low + high);
      spread.low[axis] = count == 0 ? center : std::min(spread.low[axis], center);
      spread.high[axis] = count == 0 ? center : std::max(spread.high[axis], center);
      spread.mean_extent[axis] += high - low;
      sum[axis] += center;
      squares[axis] += center * center;
    }
  }
  const double scale = 1 / static_cast<double>(std::max<std::size_t>(count, 1));
  double widest = -1;
  for (int axis = 0; axis < 3; ++axis) {
    spread.mean_extent[axis] *= scale;
    const double mean = sum[axis] * scale;
    spread.variance[axis] = squares[axis] * scale - mean * mean;
    if (spread.variance[axis] > widest) {
      widest = spread.variance[axis];
      spread.widest_axis = axis;
    }
  }
  return spread;
}

}  // namespace supple::benchmarks
