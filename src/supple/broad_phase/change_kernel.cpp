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
HWY_INLINE bool same(const Aabb* now, const Aabb* before) {
  const hn::CappedTag<float, 16> lanes;  // their number parts a block
  const hn::RebindToUnsigned<hn::CappedTag<float, 16>> bits;
  const float *const a = &now->min.x, *const b = &before->min.x;
  auto differ = hn::Zero(bits);
  for (std::size_t i = 0; i < kNumbers; i += hn::Lanes(lanes))
    differ = hn::Or(differ, hn::Xor(hn::BitCast(bits, hn::LoadU(lanes, a + i)),
                                    hn::BitCast(bits, hn::LoadU(lanes, b + i))));
  return hn::AllTrue(bits, hn::Eq(differ, hn::Zero(bits)));
}

std::size_t list_changed(const Aabb* now, const Aabb* before, std::size_t begin, std::size_t end,
                         std::uint32_t* out) {
  // The processor's own guesses end at each page.
  constexpr std::size_t kAhead = 192;
  std::size_t count = 0;
  for (std::size_t i = begin; i < end;) {
    const std::size_t block_end = i + kBlock < end ? i + kBlock : end;
    if (i + kAhead + kBlock <= end) {
      for (std::size_t k = 0; k < 3; ++k) {
        hwy::Prefetch(reinterpret_cast<const char*>(now + i + kAhead) + 64 * k);
        hwy::Prefetch(reinterpret_cast<const char*>(before + i + kAhead) + 64 * k);
      }
    }
    if (block_end == i + kBlock && same(now + i, before + i)) {
      i = block_end;
      continue;
    }
    for (; i < block_end; ++i) {
      out[count] = static_cast<std::uint32_t>(i);
      const bool differs = std::memcmp(now + i, before + i, sizeof(Aabb)) != 0;
      count += static_cast<std::size_t>(differs && !(now[i].empty() && before[i].empty()));
    }
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

std::size_t list_changed_boxes(const Aabb* now, const Aabb* before, std::size_t begin, std::size_t end,
                               std::uint32_t* out) {
  return HWY_DYNAMIC_DISPATCH(list_changed)(now, before, begin, end, out);
}

}  // namespace supple
#endif
