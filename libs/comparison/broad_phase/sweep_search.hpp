#pragma once

#include <cstdint>
#include <vector>

#include "broad_phase/overlap_kernel.hpp"
#include "broad_phase/pair_search.hpp"

namespace supple {

/// Sweep and prune (Baraff 1992) along the axis with the largest variance of the centres. Without sorting,
/// every volume against every other, O(n²): the reference for all other methods.
class SweepSearch final : public PairSearch {
 public:
  explicit SweepSearch(bool sorts) : sorts_(sorts) {}

  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;

 private:
  bool sorts_;
  BoxLanes lanes_;
  std::vector<std::uint64_t> order_;  // `order_key` of the boxes that are not empty
  PairSorter sorter_;
};

}  // namespace supple
