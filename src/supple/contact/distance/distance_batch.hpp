#pragma once

#include <cstdint>
#include <span>

#include "contact/distance/distance_kernels.hpp"

namespace supple {

/// Two elements and the features that hold their closest points.
struct FoundFeatures {
  ElementPoints elements;
  ClosestFeatures features;
};

/// Computes the distances and closest points of many pairs of elements at once, which takes less time than
/// one after the other and gives the same bits. Holds the memory of one worker.
class DistanceBatch {
 public:
  static constexpr std::size_t capacity = PointsBlock::capacity;
  /// `distance_of` of at most `capacity` pairs. Adds the number of those that need integers to `exact_count`.
  void compute(std::span<const FoundFeatures> pairs, std::span<ElementDistance> results,
               std::uint64_t& exact_count);
  /// The same for points and triangles, whose features it finds first.
  void find(std::span<FoundFeatures> pairs, std::span<ElementDistance> results);

 private:
  PointsBlock block_{};
  DistanceNumbersBlock numbers_{};
};

}  // namespace supple
