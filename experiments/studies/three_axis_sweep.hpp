#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "supple/broad_phase.hpp"
#include "supple/types.hpp"

namespace supple::experiments {

/// Sweep and prune with sorted lists on three axes, as Baraff describes it ("Dynamic simulation of
/// non-penetrating rigid bodies", 1992): each step sorts the lists by insertion, which is fast when the order
/// hardly changes, and each exchange of two ends can begin or end an overlap. For comparison with the sweep
/// of the library, which sorts along one axis in every step.
class ThreeAxisSweep {
 public:
  /// Sorts the lists. `pairs` are the overlapping pairs of boxes. O(n log n).
  ThreeAxisSweep(std::span<const Aabb> boxes, std::span<const IndexPair> pairs);

  /// Moves the boxes and returns the number of overlapping pairs. O(n + exchanges).
  std::size_t update(std::span<const Aabb> boxes);
  /// Exchanges of two ends in the last update.
  std::uint64_t exchanges() const { return exchanges_; }

 private:
  /// The lower or upper end of a box along one axis.
  struct End {
    float value;
    std::uint32_t box;
    bool is_upper;
    /// Boxes that touch overlap, so lower ends come first.
    bool operator<(const End& other) const {
      return value < other.value || (value == other.value && is_upper < other.is_upper);
    }
  };

  void sort_by_insertion(std::vector<End>& ends, std::span<const Aabb> boxes);

  std::array<std::vector<End>, 3> lists_;
  std::unordered_set<std::uint64_t> pairs_;
  std::uint64_t exchanges_ = 0;
};

}  // namespace supple::experiments
