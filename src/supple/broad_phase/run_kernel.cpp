#include "broad_phase/run_kernel.hpp"

#include <algorithm>
#include <bit>
#include <utility>

// Highway compiles the rest of this file once for each instruction set, and picks one when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "broad_phase/run_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Up to this length a run is sorted by counting, for each pair, those below it.
constexpr std::size_t kLongestRanked = 64;

/// By marks where there are few against the length of the run, or else by comparing two at a time.
void sort_long_run(std::span<std::uint32_t> b, bool may_repeat, std::span<std::uint64_t> marks) {
  if (may_repeat || marks.size() > 64 * b.size()) return std::sort(b.begin(), b.end());
  for (const std::uint32_t slot : b) marks[slot / 64] |= std::uint64_t{1} << slot % 64;
  std::size_t count = 0;
  for (std::size_t word = 0; count < b.size(); ++word) {
    for (std::uint64_t bits = std::exchange(marks[word], 0); bits != 0; bits &= bits - 1)
      b[count++] = static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(bits)));
  }
}

/// A pair's place in its run is the number of those below it; there is no branch that depends on the order.
void sort(std::span<const std::uint32_t> a, std::span<std::uint32_t> b,
          std::span<const std::uint32_t> run_ends, std::uint32_t first_slot, bool may_repeat,
          std::span<std::uint64_t> marks, std::span<IndexPair> sorted) {
  const hn::CappedTag<std::uint32_t, kMaxLanes> lanes;
  const std::size_t longest_ranked = may_repeat ? 0 : kLongestRanked;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t begin = run_ends[a[i]], length = run_ends[a[i] + 1] - begin;
    const std::uint32_t slot = first_slot + a[i];
    if (HWY_UNLIKELY(length > longest_ranked)) {
      if (i == begin) sort_long_run(b.subspan(begin, length), may_repeat, marks);
      sorted[i] = {slot, b[i]};
      continue;
    }
    const auto value = hn::Set(lanes, b[i]);
    std::size_t rank = 0, k = 0;
    do {
      const auto below = hn::Lt(hn::LoadU(lanes, b.data() + begin + k), value);
      rank += hn::CountTrue(lanes, hn::And(below, hn::FirstN(lanes, length - k)));
      k += hn::Lanes(lanes);
    } while (HWY_UNLIKELY(k < length));
    sorted[begin + rank] = {slot, b[i]};
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(sort);

void sort_runs(std::span<const std::uint32_t> a, std::span<std::uint32_t> b,
               std::span<const std::uint32_t> run_ends, std::uint32_t first_slot, bool may_repeat,
               std::span<std::uint64_t> marks, std::span<IndexPair> sorted) {
  HWY_DYNAMIC_DISPATCH(sort)(a, b, run_ends, first_slot, may_repeat, marks, sorted);
}

}  // namespace supple
#endif
