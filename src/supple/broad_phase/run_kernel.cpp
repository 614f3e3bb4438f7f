#include "broad_phase/run_kernel.hpp"

#include <algorithm>

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

/// Longer runs are sorted by comparing two at a time, and so are those in which a rank is not unique.
constexpr std::size_t kLongRun = 256;

/// A pair's place in its run is the number of those below it; there is no branch that depends on the order.
void sort(std::span<const std::uint32_t> a, std::span<std::uint32_t> b,
          std::span<const std::uint32_t> run_ends, std::uint32_t first_slot, bool may_repeat,
          std::span<IndexPair> sorted) {
  const hn::CappedTag<std::uint32_t, kMaxLanes> lanes;
  const std::size_t longest_ranked = may_repeat ? 0 : kLongRun;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t begin = run_ends[a[i]], length = run_ends[a[i] + 1] - begin;
    const std::uint32_t slot = first_slot + a[i];
    if (HWY_UNLIKELY(length > longest_ranked)) {
      if (i == begin)
        std::sort(b.begin() + static_cast<std::ptrdiff_t>(begin),
                  b.begin() + static_cast<std::ptrdiff_t>(begin + length));
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
               std::span<IndexPair> sorted) {
  HWY_DYNAMIC_DISPATCH(sort)(a, b, run_ends, first_slot, may_repeat, sorted);
}

}  // namespace supple
#endif
