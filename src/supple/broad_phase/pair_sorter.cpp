#include "broad_phase/pair_sorter.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "geometry/sphere.hpp"

// Highway compiles the next part of this file once for each instruction set, and picks one when the program
// runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "broad_phase/pair_sorter.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// With marks where they are few against the length of the run. Repeats stay, but perhaps of another value.
void sort_long_run(std::span<std::uint32_t> b, std::span<std::uint64_t> marks) {
  if (marks.size() > 64 * b.size()) return std::sort(b.begin(), b.end());
  for (const std::uint32_t slot : b) marks[slot / 64] |= std::uint64_t{1} << slot % 64;
  std::size_t count = 0;
  for (std::size_t word = 0; word < marks.size(); ++word) {
    for (std::uint64_t bits = std::exchange(marks[word], 0); bits != 0; bits &= bits - 1)
      b[count++] = static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(bits)));
  }
  std::fill(b.begin() + static_cast<std::ptrdiff_t>(count), b.end(), b[count - 1]);
}

/// Sorts the run of each a by b. A pair's place in its run is the number of pairs before it in the order,
/// counted without a branch that depends on the order. `b` is readable `max_lanes` past its end.
void sort_runs(std::span<const std::uint32_t> a, std::span<std::uint32_t> b,
               std::span<const std::uint32_t> run_ends, std::uint32_t first_slot,
               std::span<std::uint64_t> marks, IndexPair* sorted) {
  constexpr std::size_t longest_counted = 64;
  const hn::CappedTag<std::uint32_t, max_lanes> lanes;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t begin = run_ends[a[i]], length = run_ends[a[i] + 1] - begin;
    const std::uint32_t slot = first_slot + a[i];
    if (HWY_UNLIKELY(length > longest_counted)) {
      if (i == begin) sort_long_run(b.subspan(begin, length), marks);
      sorted[i] = {slot, b[i]};
      continue;
    }
    const auto value = hn::Set(lanes, b[i]);
    std::size_t rank = 0, k = begin;
    do {
      const auto others = hn::LoadU(lanes, b.data() + k);
      const auto below = hn::And(hn::Lt(others, value), hn::FirstN(lanes, begin + length - k));
      const auto equal_before = hn::And(hn::Eq(others, value), hn::FirstN(lanes, i - std::min(i, k)));
      rank += hn::CountTrue(lanes, hn::Or(below, equal_before));
      k += hn::Lanes(lanes);
    } while (HWY_UNLIKELY(k < begin + length));
    sorted[begin + rank] = {slot, b[i]};
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(sort_runs);

void PairBins::reset(int shift, std::size_t bin_count) {
  shift_ = shift;
  chunk_count_ = bin_count;
  if (before_.size() < bin_count) {
    before_.resize(2 * bin_count);
    pool_.resize(before_.size() * chunk_size);
  }
  next_.resize(bin_count);
  for (std::size_t bin = 0; bin < bin_count; ++bin) next_[bin] = bin * chunk_size;
}

std::size_t PairBins::chunk_after(std::size_t chunk) {
  if (chunk_count_ == before_.size()) {
    before_.resize(2 * chunk_count_);
    pool_.resize(before_.size() * chunk_size);
  }
  before_[chunk_count_] = static_cast<std::uint32_t>(chunk);
  prefetch(chunk_count_);
  return chunk_count_++ * chunk_size;
}

void PairBins::flush(std::size_t count, std::span<const BoundingSphere> spheres) {
  if (!spheres.empty()) {
    const std::size_t all = std::exchange(count, 0);
    for (std::size_t i = 0; i < all; ++i) {
      const std::uint32_t a = first[i], b = second[i];
      first[count] = a;
      second[count] = b;
      count += static_cast<std::size_t>(overlap(spheres[a], spheres[b]));
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const IndexPair pair{std::min(first[i], second[i]), std::max(first[i], second[i])};
    std::size_t& next = next_[pair.a >> shift_];
    pool_[next] = pair;
    if (++next % chunk_size == 0) next = chunk_after(next / chunk_size - 1);
  }
}

std::size_t PairBins::count(std::size_t bin) const {
  std::size_t sum = 0;
  for_each_chunk(bin, [&](std::span<const IndexPair> pairs) { sum += pairs.size(); });
  return sum;
}

std::span<PairBins> PairSorter::start(std::size_t workers, std::size_t slot_count) {
  // The counters of a bin stay in the first-level cache, and so do the places where a worker writes next.
  constexpr int bits = 11;
  shift_ = std::max(bits, static_cast<int>(std::bit_width(slot_count)) - bits);
  slot_count_ = slot_count;
  bins_.resize(workers);
  const std::size_t bin_count = (slot_count >> shift_) + 1;
  for (PairBins& bins : bins_) bins.reset(shift_, bin_count);
  bin_begins_.resize(bin_count + 1);
  return bins_;
}

void PairSorter::finish(const Parallel& parallel, std::vector<IndexPair>& sorted) {
  const std::size_t bin_count = bin_begins_.size() - 1;
  bin_begins_[0] = 0;
  for (std::size_t bin = 0; bin < bin_count; ++bin) {
    bin_begins_[bin + 1] = bin_begins_[bin];
    for (const PairBins& bins : bins_) bin_begins_[bin + 1] += bins.count(bin);
  }
  sorted.resize(bin_begins_[bin_count]);
  scratch_.resize(parallel.worker_count());
  parallel.for_ranges(bin_count, 1, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t bin = begin; bin < end; ++bin)
      sort_bin(bin, scratch_[worker],
               {sorted.data() + bin_begins_[bin], bin_begins_[bin + 1] - bin_begins_[bin]});
  });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

void PairSorter::sort_bin(std::size_t bin, Scratch& scratch, std::span<IndexPair> sorted) const {
  if (sorted.empty()) return;
  const auto first_slot = static_cast<std::uint32_t>(bin << shift_);
  scratch.ends.assign(std::min(std::size_t{1} << shift_, slot_count_ - first_slot) + 1, 0);
  scratch.marks.resize(slot_count_ / 64 + 1, 0);
  if (scratch.a.size() < sorted.size() + max_lanes) {
    scratch.a.resize(sorted.size() + sorted.size() / 2 + max_lanes);
    scratch.b.resize(scratch.a.size());
  }
  // next[a] counts the pairs of a, then holds the place of the next one, and at last the end of the run.
  std::uint32_t* const next = scratch.ends.data() + 1;
  const auto for_each_pair = [&](auto&& visit) {
    for (const PairBins& bins : bins_)
      bins.for_each_chunk(bin, [&](std::span<const IndexPair> pairs) {
        for (const IndexPair pair : pairs) visit(pair.a - first_slot, pair.b);
      });
  };
  for_each_pair([&](std::uint32_t a, std::uint32_t) { ++next[a]; });
  std::uint32_t begin = 0;
  for (std::size_t a = 0; a + 1 < scratch.ends.size(); ++a) begin += std::exchange(next[a], begin);
  for_each_pair([&, run_a = scratch.a.data(), run_b = scratch.b.data()](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t place = next[a]++;
    run_a[place] = a;
    run_b[place] = b;
  });
  HWY_DYNAMIC_DISPATCH(sort_runs)
  ({scratch.a.data(), sorted.size()}, {scratch.b.data(), sorted.size()}, scratch.ends, first_slot,
   scratch.marks, sorted.data());
}

}  // namespace supple
#endif
