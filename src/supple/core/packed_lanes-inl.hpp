// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_CORE_PACKED_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_CORE_PACKED_LANES_INL_HPP
#undef SUPPLE_CORE_PACKED_LANES_INL_HPP
#else
#define SUPPLE_CORE_PACKED_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>

#include "core/packed_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

/// Moves the words of the set lanes to the front. The words behind them are undefined.
template <class Words>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<Words> packed_lanes(Words lanes, hwy::HWY_NAMESPACE::Vec<Words> words,
                                                       hwy::HWY_NAMESPACE::Mask<Words> set) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_ARCH_X86 && HWY_TARGET > HWY_AVX3 && HWY_TARGET != HWY_SCALAR
  // gcc 12 copies Highway's own table to the stack in each call.
  std::array<std::uint8_t, 8> bits{};
  hn::StoreMaskBits(lanes, set, bits.data());
  const hn::Rebind<std::uint8_t, Words> bytes;
  const auto from = hn::PromoteTo(lanes, hn::LoadU(bytes, packed_lane_tables[bits[0]].data()));
  return hn::TableLookupLanes(words, hn::IndicesFromVec(lanes, from));
#else
  static_cast<void>(lanes);
  return hn::Compress(words, set);
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
