#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/broad_phase.hpp"

namespace supple {

/// The largest number of lanes of a kernel. Its arrays are readable this far past their last item.
inline constexpr std::size_t max_lanes = 16;

/// The pairs that one worker finds.
class PairList {
 public:
  /// Kernels write pairs here, in any order of the two slots. `flush` adds them to the list.
  static constexpr std::size_t batch_size = 2048;
  std::array<std::uint32_t, batch_size + 2 * max_lanes> first, second;

  /// Adds the first `count` pairs of the batch; with spheres only the pairs whose spheres overlap.
  void flush(std::size_t count, std::span<const BoundingSphere> spheres);

 private:
  friend class PairSorter;
  std::vector<IndexPair> pairs_;
  std::vector<std::size_t> bin_places_;
};

/// Sorts the pairs of all workers by (a, b): into bins by the upper bits of a, then each bin by digits.
/// O(pairs + slots). It keeps its memory for the next search, except that for more than a million pairs.
class PairSorter {
 public:
  /// One empty list for each worker. Every slot of a pair is less than `slot_count`.
  std::span<PairList> start(std::size_t workers, std::size_t slot_count);
  /// Replaces `sorted` by the pairs of all lists. A pair that was found several times may appear several
  /// times.
  void finish(const Parallel& parallel, std::vector<IndexPair>& sorted);

 private:
  void sort_bin(std::size_t bin, std::vector<std::uint32_t>& counters, IndexPair* sorted);

  std::size_t slot_count_ = 0;
  int shift_ = 0;  // the bin of a pair is a >> shift_
  std::vector<PairList> lists_;
  std::vector<IndexPair> binned_;
  std::vector<std::size_t> bin_begins_;               // one more than bins
  std::vector<std::vector<std::uint32_t>> counters_;  // per worker
};

}  // namespace supple
