#pragma once

#include <vector>

#include "broad_phase/box_lanes.hpp"
#include "broad_phase/pair_finder.hpp"
#include "broad_phase/pair_sorter.hpp"

namespace supple {

/// Every volume against every other, O(n²). The reference that the other methods are held against.
class BruteForce final : public PairFinder {
 public:
  explicit BruteForce(BoundingVolume bounding_volume) : bounding_volume_(bounding_volume) {}

  std::span<const IndexPair> find_pairs(const ObjectVolumes& volumes, const Parallel& parallel) override;

 private:
  BoundingVolume bounding_volume_;
  BoxLanes lanes_;
  std::vector<PairBuffer> found_;  // per worker
  PairSorter sorter_;
  std::vector<IndexPair> pairs_;
};

}  // namespace supple
