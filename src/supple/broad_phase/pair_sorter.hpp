#pragma once

#include <hwy/cache_control.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/broad_phase.hpp"

namespace supple {

/// Most lanes that a kernel takes at once; arrays are readable this far past their last item.
inline constexpr std::size_t max_lanes = 16;

/// Pairs of one worker, binned by the upper bits of a. A bin is a list of chunks.
class PairBins {
 public:
  /// Kernels write pairs here, in any order of the two slots, and `flush` moves them into the bins.
  static constexpr std::size_t batch_size = 2048;
  std::array<std::uint32_t, batch_size + 2 * max_lanes> first, second;

  /// Empties all bins. The bin of a pair is `a >> shift`, less than `bin_count`.
  void reset(int shift, std::size_t bin_count);
  /// Adds the first `count` pairs of the batch; with spheres only those whose spheres overlap.
  void flush(std::size_t count, std::span<const BoundingSphere> spheres);
  std::size_t count(std::size_t bin) const;
  /// Calls `visit(pairs)` for parts of a bin, in no order.
  template <class Visit>
  void for_each_chunk(std::size_t bin, Visit&& visit) const {
    std::size_t chunk = next_[bin] / chunk_size, size = next_[bin] % chunk_size;
    while (true) {
      if (chunk != bin) prefetch(before_[chunk]);
      visit(std::span<const IndexPair>(pool_.data() + chunk * chunk_size, size));
      if (chunk == bin) return;
      chunk = before_[chunk];
      size = chunk_size;
    }
  }

 private:
  static constexpr std::size_t chunk_size = 128, pairs_per_cache_line = 8;
  /// Where a further chunk of the same bin begins.
  std::size_t chunk_after(std::size_t chunk);
  /// Chunks of a bin are apart in memory, so the hardware does not prefetch the next one.
  void prefetch(std::size_t chunk) const {
    const IndexPair* const begin = pool_.data() + chunk * chunk_size;
    for (std::size_t i = 0; i < chunk_size; i += pairs_per_cache_line) hwy::Prefetch(begin + i);
  }

  int shift_ = 0;
  std::size_t chunk_count_ = 0;
  std::vector<std::size_t> next_;      // per bin, where its next pair goes; chunk i is the first of bin i
  std::vector<std::uint32_t> before_;  // per chunk, the previous chunk of its bin
  std::vector<IndexPair> pool_;
};

/// Sorts the pairs of all workers by (a, b): bins by the upper bits of a, a counting sort by a in each bin,
/// then each run of equal a by b. O(pairs + slots) while no object has very many pairs.
class PairSorter {
 public:
  /// Empty bins, one set for each worker. Every slot of a pair is less than `slot_count`.
  std::span<PairBins> start(std::size_t workers, std::size_t slot_count);
  /// Replaces `sorted` by the pairs in the bins, each once.
  void finish(const Parallel& parallel, std::vector<IndexPair>& sorted);

 private:
  /// Memory of one worker.
  struct Scratch {
    std::vector<std::uint32_t> ends;   // of runs, per slot of a bin
    std::vector<std::uint32_t> a, b;   // of the pairs of a bin, runs one behind the other
    std::vector<std::uint64_t> marks;  // bit per slot, all 0 between runs
  };
  void sort_bin(std::size_t bin, Scratch& scratch, std::span<IndexPair> sorted) const;

  std::size_t slot_count_ = 0;
  int shift_ = 0;
  std::vector<PairBins> bins_;           // per worker
  std::vector<std::size_t> bin_begins_;  // and one more
  std::vector<Scratch> scratch_;         // per worker
};

}  // namespace supple
