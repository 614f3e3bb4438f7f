#include "studies/three_axis_sweep.hpp"

#include <algorithm>

namespace supple::experiments {
namespace {

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

bool overlap(const Aabb& a, const Aabb& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.max[axis] < b.min[axis] || b.max[axis] < a.min[axis]) return false;
  }
  return true;
}

}  // namespace

ThreeAxisSweep::ThreeAxisSweep(std::span<const Aabb> boxes, std::span<const IndexPair> pairs) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<End>& ends = lists_[static_cast<std::size_t>(axis)];
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      ends.push_back({boxes[i].min[axis], i, false});
      ends.push_back({boxes[i].max[axis], i, true});
    }
    std::sort(ends.begin(), ends.end());
  }
  for (const auto& [a, b] : pairs) pairs_.insert(key_of(a, b));
}

std::size_t ThreeAxisSweep::update(std::span<const Aabb> boxes) {
  exchanges_ = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<End>& ends = lists_[static_cast<std::size_t>(axis)];
    for (End& end : ends) end.value = (end.is_upper ? boxes[end.box].max : boxes[end.box].min)[axis];
    sort_by_insertion(ends, boxes);
  }
  return pairs_.size();
}

void ThreeAxisSweep::sort_by_insertion(std::vector<End>& ends, std::span<const Aabb> boxes) {
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const End moving = ends[i];
    std::size_t to = i;
    for (; to > 0 && moving < ends[to - 1]; --to) {
      const End passed = ends[to - 1];
      ends[to] = passed;
      ++exchanges_;
      if (moving.is_upper == passed.is_upper) continue;
      if (moving.is_upper)
        pairs_.erase(key_of(moving.box, passed.box));
      else if (overlap(boxes[moving.box], boxes[passed.box]))
        pairs_.insert(key_of(moving.box, passed.box));
    }
    ends[to] = moving;
  }
}

}  // namespace supple::experiments
