#include "broad_phase/pair_sorter.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "geometry/sphere.hpp"

namespace supple {
namespace {

/// One run of equal a. Most are shorter than a handful.
void sort_run(IndexPair* begin, IndexPair* end) {
  constexpr std::ptrdiff_t kInsertionLimit = 24;
  if (end - begin > kInsertionLimit) {
    std::sort(begin, end, [](IndexPair x, IndexPair y) { return x.b < y.b; });
    return;
  }
  for (IndexPair* i = begin + 1; i < end; ++i) {
    const IndexPair pair = *i;
    IndexPair* hole = i;
    for (; hole != begin && pair.b < hole[-1].b; --hole) *hole = hole[-1];
    *hole = pair;
  }
}

/// Pairs whose a is in [first_slot, first_slot + slot_count), of less than 2^32.
void sort_bucket(std::span<const IndexPair> pairs, std::uint32_t first_slot, std::size_t slot_count,
                 std::vector<std::uint32_t>& run_end, IndexPair* sorted) {
  run_end.assign(slot_count + 1, 0);
  for (const IndexPair pair : pairs) ++run_end[pair.a - first_slot + 1];
  for (std::size_t slot = 0; slot < slot_count; ++slot) run_end[slot + 1] += run_end[slot];
  // From here run_end[a] is where the next pair of a goes, and at last where its run ends.
  for (const IndexPair pair : pairs) sorted[run_end[pair.a - first_slot]++] = pair;
  std::uint32_t begin = 0;
  for (std::size_t slot = 0; slot < slot_count; begin = run_end[slot++])
    if (run_end[slot] - begin > 1) sort_run(sorted + begin, sorted + run_end[slot]);
}

}  // namespace

void PairSorter::sort(std::span<const PairBuffer> parts, std::size_t slot_count, bool may_repeat,
                      const Parallel& parallel, std::vector<IndexPair>& sorted) {
  std::size_t total = 0;
  for (const PairBuffer& part : parts) total += part.size();
  sorted.resize(total);
  // Counters of 32 bits halve the memory that is hit at random.
  const bool countable = total <= std::numeric_limits<std::uint32_t>::max();
  if (countable && total >= slot_count / 16) {
    sort_by_counting(parts, slot_count, parallel, sorted);
  } else {
    auto out = sorted.begin();
    for (const PairBuffer& part : parts) out = std::copy_n(part.data(), part.size(), out);
    std::sort(sorted.begin(), sorted.end());
  }
  if (may_repeat) sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

void PairSorter::sort_by_counting(std::span<const PairBuffer> parts, std::size_t slot_count,
                                  const Parallel& parallel, std::vector<IndexPair>& sorted) {
  // Counters of a bucket stay in the first-level cache, and so do the places that a part writes to next.
  constexpr int kBits = 11;
  const int shift = std::max(kBits, static_cast<int>(std::bit_width(slot_count)) - kBits);
  const std::size_t bucket_count = (slot_count >> shift) + 1;
  fill_buckets(parts, shift, bucket_count, parallel);
  counters_.resize(parallel.worker_count());
  parallel.for_ranges(bucket_count, 1, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t bucket = begin; bucket < end; ++bucket) {
      const std::size_t first = bucket == 0 ? 0 : bucket_end_[bucket - 1], first_slot = bucket << shift;
      sort_bucket({bucketed_.data() + first, bucket_end_[bucket] - first},
                  static_cast<std::uint32_t>(first_slot),
                  std::min(std::size_t{1} << shift, slot_count - first_slot), counters_[worker],
                  sorted.data() + first);
    }
  });
}

/// Pairs by the upper bits of a. Each part has its own places in each bucket.
void PairSorter::fill_buckets(std::span<const PairBuffer> parts, int shift, std::size_t bucket_count,
                              const Parallel& parallel) {
  const auto each_pair = [&](auto&& visit) {
    parallel.for_ranges(parts.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t part = begin; part < end; ++part) {
        std::size_t* const places = places_.data() + part * bucket_count;
        for (std::size_t i = 0; i < parts[part].size(); ++i) {
          const IndexPair pair = parts[part].data()[i];
          visit(places[pair.a >> shift], pair);
        }
      }
    });
  };
  places_.assign(parts.size() * bucket_count, 0);
  each_pair([](std::size_t& place, IndexPair) { ++place; });
  bucket_end_.resize(bucket_count);
  std::size_t total = 0;
  for (std::size_t bucket = 0; bucket < bucket_count; ++bucket) {
    for (std::size_t part = 0; part < parts.size(); ++part)
      total += std::exchange(places_[part * bucket_count + bucket], total);
    bucket_end_[bucket] = total;
  }
  bucketed_.resize(total);
  each_pair([&](std::size_t& place, IndexPair pair) { bucketed_[place++] = pair; });
}

void keep_overlapping_spheres(std::span<const BoundingSphere> spheres, std::size_t first, PairBuffer& pairs) {
  IndexPair* const begin = pairs.data() + first;
  IndexPair* const end = pairs.data() + pairs.size();
  IndexPair* const kept =
      std::remove_if(begin, end, [&](IndexPair pair) { return !overlap(spheres[pair.a], spheres[pair.b]); });
  pairs.truncate(static_cast<std::size_t>(kept - pairs.data()));
}

}  // namespace supple
