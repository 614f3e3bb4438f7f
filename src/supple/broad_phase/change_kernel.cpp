#include "broad_phase/change_kernel.hpp"

#include <cstring>

// Highway compiles the rest of this file once for each instruction set, and picks one when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "broad_phase/change_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kBlock = 8;
constexpr std::size_t kNumbers = kBlock * sizeof(Aabb) / sizeof(float);

/// Whether two blocks of boxes are the same bit by bit.
HWY_INLINE bool same_block(const Aabb* now, const Aabb* before) {
  const hn::CappedTag<float, 16> lanes;  // their number parts a block
  const hn::RebindToUnsigned<hn::CappedTag<float, 16>> bits;
  const float *const a = &now->min.x, *const b = &before->min.x;
  auto differ = hn::Zero(bits);
  for (std::size_t i = 0; i < kNumbers; i += hn::Lanes(lanes))
    differ = hn::Or(differ, hn::Xor(hn::BitCast(bits, hn::LoadU(lanes, a + i)),
                                    hn::BitCast(bits, hn::LoadU(lanes, b + i))));
  return hn::AllTrue(bits, hn::Eq(differ, hn::Zero(bits)));
}

/// Whether a box is another than it was.
#if HWY_TARGET == HWY_SCALAR
bool differ(const Aabb& now, const Aabb& before) {
  return std::memcmp(&now, &before, sizeof(Aabb)) != 0 && !(now.empty() && before.empty());
}
#else
HWY_INLINE bool differ(const Aabb& now, const Aabb& before) {
  // The first four and the last four numbers.
  const hn::Full128<float> lanes;
  const hn::Full128<std::uint32_t> bits;
  const auto mins = hn::LoadU(lanes, &now.min.x), maxs = hn::LoadU(lanes, &now.min.z);
  const auto first = hn::Xor(hn::BitCast(bits, mins), hn::BitCast(bits, hn::LoadU(lanes, &before.min.x)));
  const auto last = hn::Xor(hn::BitCast(bits, maxs), hn::BitCast(bits, hn::LoadU(lanes, &before.min.z)));
  const bool same = hn::AllTrue(bits, hn::Eq(hn::Or(first, last), hn::Zero(bits)));
  const auto is_below = hn::And(hn::Le(mins, hn::Shuffle0321(maxs)), hn::FirstN(lanes, 3));
  if (HWY_UNLIKELY(hn::CountTrue(lanes, is_below) != 3)) return !same && !before.empty();
  return !same;
}
#endif

/// The processor's own guesses of what is read next end at each page.
constexpr std::size_t kAhead = 192;

HWY_INLINE void fetch_ahead(const Aabb* now, const Aabb* before, std::size_t i) {
  for (std::size_t k = 0; k < 3; ++k) {
    hwy::Prefetch(reinterpret_cast<const char*>(now + i + kAhead) + 64 * k);
    hwy::Prefetch(reinterpret_cast<const char*>(before + i + kAhead) + 64 * k);
  }
}

std::size_t list_changed(const Aabb* now, const Aabb* before, std::size_t begin, std::size_t end,
                         std::uint32_t* out) {
  std::size_t count = 0;
  for (std::size_t i = begin; i < end;) {
    const std::size_t block_end = i + kBlock < end ? i + kBlock : end;
    if (i + kAhead + kBlock <= end) fetch_ahead(now, before, i);
    if (block_end == i + kBlock && same_block(now + i, before + i)) {
      i = block_end;
      continue;
    }
    for (; i < block_end; ++i) {
      out[count] = static_cast<std::uint32_t>(i);
      count += static_cast<std::size_t>(differ(now[i], before[i]));
    }
  }
  return count;
}

std::size_t take_over(const Aabb* now, Aabb* before, std::size_t begin, std::size_t end) {
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if ((i - begin) % kBlock == 0) fetch_ahead(now, before, i);  // past the end too, where the next begin
    count += static_cast<std::size_t>(differ(now[i], before[i]));
    before[i] = now[i];
  }
  return count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(list_changed);
HWY_EXPORT(take_over);

std::size_t list_changed_boxes(const Aabb* now, const Aabb* before, std::size_t begin, std::size_t end,
                               std::uint32_t* out) {
  return HWY_DYNAMIC_DISPATCH(list_changed)(now, before, begin, end, out);
}

std::size_t take_over_boxes(const Aabb* now, Aabb* before, std::size_t begin, std::size_t end) {
  return HWY_DYNAMIC_DISPATCH(take_over)(now, before, begin, end);
}

}  // namespace supple
#endif
