#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "broad_phase/box_lanes.hpp"
#include "core/parallel.hpp"

namespace supple {

/// Puts the pairs that workers found into the canonical order, by a and then b.
class PairSorter {
 public:
  /// Replaces `sorted` by the pairs of all `parts`. Every a is below `slot_count`. Duplicates are dropped
  /// when there may be some. Buckets by the upper bits of a, in each a counting sort by a, then each run by
  /// b: O(pairs + slots) while no object has very many pairs.
  void sort(std::span<const PairBuffer> parts, std::size_t slot_count, bool may_repeat,
            const Parallel& parallel, std::vector<IndexPair>& sorted);

 private:
  void sort_by_counting(std::span<const PairBuffer> parts, std::size_t slot_count, const Parallel& parallel,
                        std::vector<IndexPair>& sorted);

  void fill_buckets(std::span<const PairBuffer> parts, int shift, std::size_t bucket_count,
                    const Parallel& parallel);

  std::vector<std::size_t> places_;      // per part and bucket, where its next pair goes
  std::vector<std::size_t> bucket_end_;  // per bucket
  std::vector<IndexPair> bucketed_;
  std::vector<std::vector<std::uint32_t>> counters_;  // per worker
};

/// Drops the pairs from `first` on whose balls do not overlap.
void keep_overlapping_spheres(std::span<const BoundingSphere> spheres, std::size_t first, PairBuffer& pairs);

}  // namespace supple
