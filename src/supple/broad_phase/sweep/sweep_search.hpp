#pragma once

#include <cstdint>
#include <vector>

#include "broad_phase/overlap_kernel.hpp"
#include "broad_phase/pair_search.hpp"

namespace supple {

/// Sweep and prune (Baraff 1992) along the axis on which the objects are spread widest. The order of the step
/// before is kept, and repaired by insertion when few objects changed places.
class SweepSearch final : public PairSearch {
 public:
  void search(VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;
  std::string validate(const VolumeStore& volumes) const override;

 private:
  void choose_axis(std::span<const Aabb> boxes);
  void update_order(std::span<const Aabb> boxes);
  bool insert_in_order();
  std::uint64_t key_of(std::span<const Aabb> boxes, std::uint32_t slot) const;

  int axis_ = 0;
  std::vector<std::uint64_t> order_;    // `key_of` each box that is not empty, ascending
  std::vector<std::uint8_t> in_order_;  // per slot: `order_` has it
  BoxLanes lanes_;
  PairSorter sorter_;
};

}  // namespace supple
