// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_BROAD_PHASE_MEASURE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_BROAD_PHASE_MEASURE_INL_HPP
#undef SUPPLE_BROAD_PHASE_MEASURE_INL_HPP
#else
#define SUPPLE_BROAD_PHASE_MEASURE_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>

#include "broad_phase/row_kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Boxes in whole steps.
#if HWY_TARGET == HWY_SCALAR
class Measure {
 public:
  explicit Measure(const BoxMeasure& measure) : measure_(measure) {}
  /// Ends in steps, or false when the box is empty.
  bool ends(const Aabb& box, MeasuredBox& out, std::array<std::uint32_t, 4>& extents) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int k = static_cast<int>(axis);
      const std::uint32_t low = step(box.min[k], axis), high = step(box.max[k], axis);
      out.ends[axis] = low | (0xffff - high) << 16;
      extents[axis] = high - low;
    }
    return !box.empty();
  }

 private:
  /// NaN, which only empty boxes have, is 1.
  std::uint32_t step(float value, std::size_t axis) const {
    const float place = (value - measure_.low[axis]) * measure_.steps_per_unit[axis];
    const float clamped = place > 1 ? std::min(place, kSteps - 2.0f) : 1.0f;
    return std::bit_cast<std::uint32_t>(clamped + 0x1p23f) & 0xffff;
  }

  const BoxMeasure& measure_;
};
#else
/// A box is loaded as its first four and its last four numbers.
class Measure {
 public:
  explicit Measure(const BoxMeasure& measure) {
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t axis = (i < 4 ? i : i + 1) % 3;  // x y z x, then z x y z
      low_[i] = measure.low[axis];
      scale_[i] = measure.steps_per_unit[axis];
    }
  }
  /// Ends in steps, or false when the box is empty.
  HWY_INLINE bool ends(const Aabb& box, MeasuredBox& out, std::array<std::uint32_t, 4>& extents) const {
    const hn::Full128<std::uint32_t> words;
    const auto mins = hn::LoadU(floats, &box.min.x);      // and max x
    const auto end_part = hn::LoadU(floats, &box.min.z);  // and the other maxima
    const auto first = steps(mins, 0), last = hn::Shuffle0321(steps(end_part, 4));
    const auto ends = hn::Or(first, hn::ShiftLeft<16>(hn::Sub(hn::Set(words, 0xffffu), last)));
    hn::Store(ends, words, out.ends.data());
    hn::StoreU(hn::Sub(last, first), words, extents.data());
    const auto is_below = hn::Le(mins, hn::Shuffle0321(end_part));
    return hn::CountTrue(floats, hn::And(is_below, hn::FirstN(floats, 3))) == 3;
  }

 private:
  static constexpr hn::Full128<float> floats{};

  /// To whole numbers by the bits that are left when 2^23 is added.
  HWY_INLINE hn::Vec<hn::Full128<std::uint32_t>> steps(hn::Vec<hn::Full128<float>> values,
                                                       std::size_t i) const {
    const hn::Full128<std::uint32_t> words;
    const auto place =
        hn::Mul(hn::Sub(values, hn::Load(floats, low_.data() + i)), hn::Load(floats, scale_.data() + i));
    const auto clamped = hn::Min(hn::Max(place, hn::Set(floats, 1.0f)), hn::Set(floats, kSteps - 2.0f));
    return hn::And(hn::BitCast(words, hn::Add(clamped, hn::Set(floats, 0x1p23f))), hn::Set(words, 0xffffu));
  }

  alignas(16) std::array<float, 8> low_, scale_;
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
