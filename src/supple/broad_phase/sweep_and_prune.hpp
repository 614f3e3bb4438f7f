#pragma once

#include <cstdint>
#include <vector>

#include "broad_phase/box_lanes.hpp"
#include "broad_phase/pair_finder.hpp"
#include "broad_phase/pair_sorter.hpp"

namespace supple {

/// Sweep and prune (Baraff 1992) along the axis on which the objects are spread widest. The order of the step
/// before is kept and mended where few objects changed places.
class SweepAndPrune final : public PairFinder {
 public:
  explicit SweepAndPrune(BoundingVolume bounding_volume) : bounding_volume_(bounding_volume) {}

  std::span<const IndexPair> find_pairs(const ObjectVolumes& volumes, const Parallel& parallel) override;
  std::string validate() const override;

 private:
  /// Where a box begins along the axis, as an integer that sorts alike, and whose it is.
  struct Begin {
    std::uint32_t position;
    std::uint32_t slot;
  };

  void take_volumes(const ObjectVolumes& volumes);
  void choose_axis();
  void update_order();
  void sort_order();

  BoundingVolume bounding_volume_;
  int axis_ = 0;
  std::vector<Aabb> boxes_;  // per slot
  std::vector<Begin> order_, scratch_;
  std::vector<std::uint8_t> in_order_;  // per slot: `order_` has it
  BoxLanes lanes_;
  std::vector<PairBuffer> found_;  // per worker
  PairSorter sorter_;
  std::vector<IndexPair> pairs_;
};

}  // namespace supple
