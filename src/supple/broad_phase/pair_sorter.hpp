#pragma once

#include <hwy/cache_control.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broad_phase/box_lanes.hpp"
#include "core/parallel.hpp"

namespace supple {

/// Pairs of one worker by the upper bits of a, in chunks.
class PairBins {
 public:
  /// Empty again. The bin of a pair is `a >> shift`, less than `bin_count`.
  void reset(int shift, std::size_t bin_count);
  void push(IndexPair pair) {
    std::size_t& next = next_[pair.a >> shift_];
    pool_[next] = pair;
    if (++next % kChunk == 0) next = chunk_after(next / kChunk - 1);
  }
  /// All pairs (first[i], second[i]), the smaller index first.
  void push_all(const std::uint32_t* first, const std::uint32_t* second, std::size_t count);
  std::size_t count(std::size_t bin) const;
  /// Calls `visit(pairs)` for parts of a bin, in no order.
  template <class Visit>
  void for_each_chunk(std::size_t bin, Visit&& visit) const {
    std::size_t chunk = next_[bin] / kChunk, size = next_[bin] % kChunk;
    while (true) {
      if (chunk != bin) fetch(before_[chunk]);
      visit(std::span<const IndexPair>(pool_.data() + chunk * kChunk, size));
      if (chunk == bin) return;
      chunk = before_[chunk];
      size = kChunk;
    }
  }

 private:
  static constexpr std::size_t kChunk = 128, kPairsPerLine = 8;
  /// Where a further chunk of the same bin begins.
  std::size_t chunk_after(std::size_t chunk);
  /// Chunks of a bin lie apart in memory: the processor does not guess which comes next.
  void fetch(std::size_t chunk) const {
    const IndexPair* const first = pool_.data() + chunk * kChunk;
    for (std::size_t i = 0; i < kChunk; i += kPairsPerLine) hwy::Prefetch(first + i);
  }

  int shift_ = 0;
  std::size_t chunk_count_ = 0;
  std::vector<std::size_t> next_;      // per bin, where its next pair goes; chunk i is the first of bin i
  std::vector<std::uint32_t> before_;  // per chunk, the one that was filled before it
  std::vector<IndexPair> pool_;
};

/// Puts the pairs that workers found into the canonical order, by a and then b: bins by the upper bits of a,
/// in each a counting sort by a, then each run by b. O(pairs + slots) while no object has very many pairs.
class PairSorter {
 public:
  /// Empty bins for so many workers. Every a is to be below `slot_count`.
  std::span<PairBins> start(std::size_t workers, std::size_t slot_count);
  /// Replaces `sorted` by the pairs in the bins. Duplicates are dropped when there may be some.
  void finish(bool may_repeat, const Parallel& parallel, std::vector<IndexPair>& sorted);
  /// Both, for pairs that were found elsewhere.
  void sort(std::span<const PairBuffer> parts, std::size_t slot_count, bool may_repeat,
            const Parallel& parallel, std::vector<IndexPair>& sorted);

 private:
  /// Memory of one worker.
  struct Runs {
    std::vector<std::uint32_t> end;  // per slot of a bin
    std::vector<std::uint32_t> a, b;
    std::vector<std::uint64_t> marks;  // bit per slot, all 0 between bins
  };
  void sort_bin(std::size_t bin, bool may_repeat, Runs& runs, std::span<IndexPair> sorted) const;

  std::size_t slot_count_ = 0;
  int shift_ = 0;
  std::vector<PairBins> bins_;           // per worker
  std::vector<std::size_t> bin_begins_;  // and one more
  std::vector<Runs> runs_;               // per worker
};

/// Drops the pairs from `first` on whose balls do not overlap.
void keep_overlapping_spheres(std::span<const BoundingSphere> spheres, std::size_t first, PairBuffer& pairs);

}  // namespace supple
