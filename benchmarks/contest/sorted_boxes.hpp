#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/types.hpp"

namespace supple::benchmarks {

/// Boxes as a structure of arrays, and room for one vector of lanes past the last.
struct BoxArrays {
  std::array<std::vector<float>, 3> low, high;
  std::vector<std::uint32_t> number;

  void resize(std::size_t count) {
    constexpr std::size_t lanes_past_last = 16;
    for (auto* const arrays : {&low, &high}) {
      for (auto& array : *arrays) array.resize(count + lanes_past_last);
    }
    number.resize(count + lanes_past_last);
  }
};

/// Radix sort of boxes by their lower faces along one axis.
class RadixSorter {
 public:
  /// Numbers of the boxes in ascending order; lasts until the next call.
  std::span<const std::uint32_t> sort(std::span<const Aabb> boxes, int axis);

 private:
  struct Entry {
    std::uint32_t key, number;
  };
  std::vector<Entry> entries_, other_;
  std::vector<std::uint32_t> order_;
};

/// What a method may decide by: bounds of the boxes' centres and their mean extents.
struct BoxSpread {
  Vec3d low, high, mean_extent, variance;
  int widest_axis = 0;  ///< of the largest variance in mean extents
};
BoxSpread spread_of(std::span<const Aabb> boxes);

}  // namespace supple::benchmarks
