#include "broad_phase/pair_sorter.hpp"

#include <algorithm>
#include <limits>

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
  run_end_.assign(slot_count + 1, 0);
  for (const PairBuffer& part : parts)
    for (std::size_t i = 0; i < part.size(); ++i) ++run_end_[part.data()[i].a + 1];
  for (std::size_t slot = 0; slot < slot_count; ++slot) run_end_[slot + 1] += run_end_[slot];
  // From here run_end_[a] is where the next pair of a goes, and at last where its run ends.
  for (const PairBuffer& part : parts) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      const IndexPair pair = part.data()[i];
      sorted[run_end_[pair.a]++] = pair;
    }
  }
  constexpr std::size_t kGrain = 4096;
  parallel.for_ranges(slot_count, kGrain, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t slot = begin; slot < end; ++slot)
      sort_run(sorted.data() + (slot == 0 ? 0 : run_end_[slot - 1]), sorted.data() + run_end_[slot]);
  });
}

void keep_overlapping_spheres(std::span<const BoundingSphere> spheres, std::size_t first, PairBuffer& pairs) {
  IndexPair* const begin = pairs.data() + first;
  IndexPair* const end = pairs.data() + pairs.size();
  IndexPair* const kept =
      std::remove_if(begin, end, [&](IndexPair pair) { return !overlap(spheres[pair.a], spheres[pair.b]); });
  pairs.truncate(static_cast<std::size_t>(kept - pairs.data()));
}

}  // namespace supple
