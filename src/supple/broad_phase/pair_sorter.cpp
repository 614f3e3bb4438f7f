#include "broad_phase/pair_sorter.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "geometry/sphere.hpp"

namespace supple {

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
  counters_.resize(parallel.worker_count());
  parallel.for_ranges(bin_count, 1, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t bin = begin; bin < end; ++bin) sort_bin(bin, counters_[worker], sorted.data());
  });
  constexpr std::size_t most_kept = std::size_t{1} << 20;
  if (total <= most_kept) return;
  std::vector<IndexPair>().swap(binned_);
  for (PairList& list : lists_) std::vector<IndexPair>().swap(list.pairs_);
}

/// Sorts by the lower half of b's bits, the upper half, and a. Each pass keeps the order of equal digits, and
/// moves the pairs between the two arrays.
void PairSorter::sort_bin(std::size_t bin, std::vector<std::uint32_t>& counters, IndexPair* sorted) {
  const std::size_t first = bin_begins_[bin], count = bin_begins_[bin + 1] - first;
  if (count == 0) return;
  const auto first_slot = static_cast<std::uint32_t>(bin << shift_);
  const auto pass = [&](const IndexPair* from, IndexPair* to, std::size_t digits, const auto& digit_of) {
    counters.assign(digits, 0);
    for (std::size_t i = 0; i < count; ++i) ++counters[digit_of(from[i])];
    std::uint32_t begin = 0;
    for (std::uint32_t& next : counters) begin += std::exchange(next, begin);
    for (std::size_t i = 0; i < count; ++i) to[counters[digit_of(from[i])]++] = from[i];
  };
  IndexPair *const binned = binned_.data() + first, *const target = sorted + first;
  const int half = (static_cast<int>(std::bit_width(slot_count_)) + 1) / 2;
  const std::uint32_t mask = (1u << half) - 1;
  pass(binned, target, std::size_t{mask} + 1, [&](const IndexPair& pair) { return pair.b & mask; });
  pass(target, binned, (slot_count_ >> half) + 1, [&](const IndexPair& pair) { return pair.b >> half; });
  pass(binned, target, std::min(std::size_t{1} << shift_, slot_count_ - first_slot),
       [&](const IndexPair& pair) { return pair.a - first_slot; });
}

}  // namespace supple
