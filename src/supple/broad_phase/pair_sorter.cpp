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

/// Sorts by setting one bit per slot, unless the run is short compared with the number of slots. Repeats
/// become repeats of the last value.
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

/// Sorts the run of each a by b. The place of a pair in its run is the number of pairs that precede it. A
/// vector comparison counts them, because the branches of other sorts would be unpredictable. `b` is readable
/// `max_lanes` past its end.
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

namespace {

/// When objects have more pairs on average, sorting by digits takes less time.
constexpr std::size_t pairs_of_slot_to_sort_by_digits = 24;
/// The counters of a digit then fit into the first-level cache.
constexpr std::size_t most_slots_to_sort_by_digits = std::size_t{1} << 26;

}  // namespace

void PairList::flush(std::size_t count, std::span<const BoundingSphere> spheres) {
  const std::size_t size = pairs_.size();
  pairs_.resize(size + count);
  IndexPair* next = pairs_.data() + size;
  for (std::size_t i = 0; i < count; ++i) {
    *next = {std::min(first[i], second[i]), std::max(first[i], second[i])};
    next += static_cast<std::ptrdiff_t>(spheres.empty() || overlap(spheres[first[i]], spheres[second[i]]));
  }
  pairs_.resize(static_cast<std::size_t>(next - pairs_.data()));
}

std::span<PairList> PairSorter::start(std::size_t workers, std::size_t slot_count) {
  // The counters of a bin stay in the first-level cache, and so do the places where a worker writes next.
  constexpr int bits = 11;
  shift_ = std::max(bits, static_cast<int>(std::bit_width(slot_count)) - bits);
  slot_count_ = slot_count;
  lists_.resize(workers);
  for (PairList& list : lists_) list.pairs_.clear();
  bin_begins_.resize((slot_count >> shift_) + 2);
  return lists_;
}

void PairSorter::finish(const Parallel& parallel, std::vector<IndexPair>& sorted) {
  const std::size_t bin_count = bin_begins_.size() - 1;
  const auto for_each_list = [&](auto&& visit) {
    parallel.for_ranges(lists_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t i = begin; i < end; ++i) visit(lists_[i]);
    });
  };
  for_each_list([&](PairList& list) {
    list.bin_places_.assign(bin_count, 0);
    for (const IndexPair pair : list.pairs_) ++list.bin_places_[pair.a >> shift_];
  });
  std::size_t total = 0;
  for (std::size_t bin = 0; bin < bin_count; ++bin) {
    bin_begins_[bin] = total;
    for (PairList& list : lists_) total += std::exchange(list.bin_places_[bin], total);
  }
  bin_begins_[bin_count] = total;
  binned_.resize(total);
  for_each_list([&](PairList& list) {
    for (const IndexPair pair : list.pairs_) binned_[list.bin_places_[pair.a >> shift_]++] = pair;
  });
  sorted.resize(total);
  scratch_.resize(parallel.worker_count());
  parallel.for_ranges(bin_count, 1, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t bin = begin; bin < end; ++bin) sort_bin(bin, scratch_[worker], sorted.data());
  });
}

void PairSorter::sort_bin(std::size_t bin, Scratch& scratch, IndexPair* sorted) {
  const std::span<IndexPair> pairs(binned_.data() + bin_begins_[bin],
                                   bin_begins_[bin + 1] - bin_begins_[bin]);
  if (pairs.empty()) return;
  const auto first_slot = static_cast<std::uint32_t>(bin << shift_);
  const std::size_t slots_of_bin = std::min(std::size_t{1} << shift_, slot_count_ - first_slot);
  if (pairs.size() >= pairs_of_slot_to_sort_by_digits * slots_of_bin &&
      slot_count_ <= most_slots_to_sort_by_digits)
    return sort_by_digits(pairs, first_slot, scratch, sorted + bin_begins_[bin]);
  scratch.ends.assign(slots_of_bin + 1, 0);
  scratch.marks.resize(slot_count_ / 64 + 1, 0);
  if (scratch.a.size() < pairs.size() + max_lanes) {
    scratch.a.resize(pairs.size() + pairs.size() / 2 + max_lanes);
    scratch.b.resize(scratch.a.size());
  }
  // next[a] counts the pairs of a, then holds the place of the next pair, and at last the end of the run.
  std::uint32_t* const next = scratch.ends.data() + 1;
  for (const IndexPair pair : pairs) ++next[pair.a - first_slot];
  std::uint32_t begin = 0;
  for (std::size_t a = 0; a + 1 < scratch.ends.size(); ++a) begin += std::exchange(next[a], begin);
  for (const IndexPair pair : pairs) {
    const std::uint32_t place = next[pair.a - first_slot]++;
    scratch.a[place] = pair.a - first_slot;
    scratch.b[place] = pair.b;
  }
  HWY_DYNAMIC_DISPATCH(sort_runs)
  ({scratch.a.data(), pairs.size()}, {scratch.b.data(), pairs.size()}, scratch.ends, first_slot,
   scratch.marks, sorted + bin_begins_[bin]);
}

/// Sorts by the lower half of b's bits, the upper half, and a. Each pass keeps the order of equal digits, and
/// moves the pairs between the two arrays.
void PairSorter::sort_by_digits(std::span<IndexPair> pairs, std::uint32_t first_slot, Scratch& scratch,
                                IndexPair* sorted) const {
  const int half = (static_cast<int>(std::bit_width(slot_count_)) + 1) / 2;
  const auto pass = [&](const IndexPair* from, IndexPair* to, int digit_bits, const auto& digit_of) {
    scratch.ends.assign((std::size_t{1} << digit_bits), 0);
    std::uint32_t* const next = scratch.ends.data();
    for (std::size_t i = 0; i < pairs.size(); ++i) ++next[digit_of(from[i])];
    std::uint32_t begin = 0;
    for (std::uint32_t& end : scratch.ends) begin += std::exchange(end, begin);
    for (std::size_t i = 0; i < pairs.size(); ++i) to[next[digit_of(from[i])]++] = from[i];
  };
  const std::uint32_t mask = (1u << half) - 1;
  pass(pairs.data(), sorted, half, [&](const IndexPair& pair) { return pair.b & mask; });
  pass(sorted, pairs.data(), half, [&](const IndexPair& pair) { return pair.b >> half; });
  pass(pairs.data(), sorted, shift_, [&](const IndexPair& pair) { return pair.a - first_slot; });
}

}  // namespace supple
#endif
