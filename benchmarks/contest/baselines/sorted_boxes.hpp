#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/types.hpp"

namespace supple::benchmarks {

/// Boxes as a structure of arrays, padded by one vector.
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

/// Sorts boxes by their lower faces along one axis.
class RadixSorter {
 public:
  /// Box ids in ascending order; valid until the next call.
  std::span<const std::uint32_t> sort(std::span<const Aabb> boxes, int axis);

 private:
  struct Entry {
    std::uint32_t key, number;
  };
  std::vector<Entry> entries_, other_;
  std::vector<std::uint32_t> order_;
};

/// Statistics to choose a method by: bounds of the centres, and mean extents.
struct BoxSpread {
  Vec3d low, high, mean_extent, variance;
  int widest_axis = 0;  ///< axis with the largest variance relative to the mean extent
};
BoxSpread spread_of(std::span<const Aabb> boxes);

}  // namespace supple::benchmarks
