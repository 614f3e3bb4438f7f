#pragma once

#include "broad_phase/overlap_kernel.hpp"
#include "broad_phase/pair_search.hpp"

namespace supple {

/// Every volume against every other, O(n²). The reference for all other methods.
class BruteSearch final : public PairSearch {
 public:
  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;

 private:
  BoxLanes lanes_;
  PairSorter sorter_;
};

}  // namespace supple
