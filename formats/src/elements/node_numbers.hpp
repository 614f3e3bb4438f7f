#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace supple {

/// The ids of vertices, by the numbers that their file gives them: any numbers, in any order.
class NodeNumbers {
 public:
  /// The next vertex has this number.
  void add(std::int64_t number) {
    is_consecutive_ = is_consecutive_ && (ids_.empty() || number - 1 == ids_.back().first);
    ids_.emplace_back(number, static_cast<std::uint32_t>(ids_.size()));
  }

  /// Call it after the last `add`, before `find`. Returns a number that two vertices have.
  std::optional<std::int64_t> sort() {
    if (is_consecutive_) return {};
    std::sort(ids_.begin(), ids_.end());
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    const auto twice = std::adjacent_find(ids_.begin(), ids_.end(), same);
    return twice == ids_.end() ? std::nullopt : std::optional(twice->first);
  }

  std::optional<std::uint32_t> find(std::int64_t number) const {
    if (ids_.empty() || number < ids_.front().first || number > ids_.back().first) return {};
    if (is_consecutive_) return static_cast<std::uint32_t>(number - ids_.front().first);
    const auto place = std::lower_bound(ids_.begin(), ids_.end(), std::pair(number, std::uint32_t{0}));
    return place->first == number ? std::optional(place->second) : std::nullopt;
  }

 private:
  std::vector<std::pair<std::int64_t, std::uint32_t>> ids_;
  bool is_consecutive_ = true;
};

}  // namespace supple
