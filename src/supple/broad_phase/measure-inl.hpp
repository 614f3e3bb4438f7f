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
  struct Reach {
    std::array<std::uint32_t, 3> extents;
    static Reach nothing() { return {}; }
    std::array<std::uint32_t, 3> largest() const { return extents; }
  };
  static std::size_t batch() { return 1; }
  bool many(const Aabb* box, std::uint32_t slot, MeasuredBox* out, Reach& reach) const {
    std::array<std::uint32_t, 4> extents;
    out->slot = slot;
    if (!ends(*box, *out, extents)) return false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      reach.extents[axis] = std::max(reach.extents[axis], extents[axis]);
    return true;
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
class Measure {
  using ManyFloats = hn::CappedTag<float, kMaxLanes>;
  using ManyWords = hn::RebindToUnsigned<ManyFloats>;
  using Packed = hn::Half<ManyWords>;

 public:
  /// The largest extents, some of them in each lane.
  struct Reach {
    hn::Vec<Packed> x, y, z;

    static HWY_INLINE Reach nothing() {
      const Packed packed;
      return {hn::Zero(packed), hn::Zero(packed), hn::Zero(packed)};
    }
    HWY_INLINE std::array<std::uint32_t, 3> largest() const {
      const Packed packed;
      return {hn::GetLane(hn::MaxOfLanes(packed, x)), hn::GetLane(hn::MaxOfLanes(packed, y)),
              hn::GetLane(hn::MaxOfLanes(packed, z))};
    }
  };
  explicit Measure(const BoxMeasure& measure) : measure_(measure) {
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t axis = (i < 4 ? i : i + 1) % 3;  // x y z x, then z x y z
      low_[i] = measure.low[axis];
      scale_[i] = measure.steps_per_unit[axis];
    }
  }
  /// Boxes that `many` takes.
  static std::size_t batch() { return hn::Lanes(ManyFloats()) / 2; }
  /// The same as `ends` for as many boxes one behind the other, with slots from `slot` on, and their reach;
  /// or false when one of them is empty.
  HWY_INLINE bool many(const Aabb* boxes, std::uint32_t slot, MeasuredBox* out, Reach& reach) const {
    const ManyFloats floats_of_two;
    // Along each axis the lower and the upper end of each box in turn.
    hn::Vec<ManyFloats> x, y, z;
    hn::LoadInterleaved3(floats_of_two, &boxes->min.x, x, y, z);
    const auto is_below = [&](hn::Vec<ManyFloats> ends)
                              HWY_ATTR { return hn::Le(ends, hn::Shuffle2301(ends)); };
    const auto below = hn::And(hn::And(is_below(x), is_below(y)), is_below(z));
    // The lower end of a box tells; to the upper one the other comparison would belong.
    const auto is_upper =
        hn::Eq(hn::And(hn::Iota(ManyWords(), 0), hn::Set(ManyWords(), 1)), hn::Set(ManyWords(), 1));
    if (!hn::AllTrue(floats_of_two, hn::Or(below, hn::RebindMask(floats_of_two, is_upper)))) return false;
    const Packed packed;
    const auto ends_x = pack(x, 0), ends_y = pack(y, 1), ends_z = pack(z, 2);
    hn::StoreInterleaved4(ends_x, ends_y, ends_z, hn::Iota(packed, slot), packed, out->ends.data());
    const auto extents = [&](hn::Vec<Packed> ends) HWY_ATTR {
      return hn::Sub(hn::Sub(hn::Set(packed, 0xffffu), hn::ShiftRight<16>(ends)),
                     hn::And(ends, hn::Set(packed, 0xffffu)));
    };
    reach.x = hn::Max(reach.x, extents(ends_x));
    reach.y = hn::Max(reach.y, extents(ends_y));
    reach.z = hn::Max(reach.z, extents(ends_z));
    return true;
  }
  /// A box is loaded as its first four and its last four numbers.
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

  HWY_INLINE hn::Vec<Packed> pack(hn::Vec<ManyFloats> ends, std::size_t axis) const {
    const ManyFloats tag;
    const ManyWords words;
    const hn::RepartitionToWide<ManyWords> boxes;
    const auto place =
        hn::Mul(hn::Sub(ends, hn::Set(tag, measure_.low[axis])), hn::Set(tag, measure_.steps_per_unit[axis]));
    const auto clamped = hn::Min(hn::Max(place, hn::Set(tag, 1.0f)), hn::Set(tag, kSteps - 2.0f));
    const auto steps =
        hn::And(hn::BitCast(words, hn::Add(clamped, hn::Set(tag, 0x1p23f))), hn::Set(words, 0xffffu));
    const auto both = hn::BitCast(boxes, steps);
    const auto upper = hn::Sub(hn::Set(boxes, 0xffffu), hn::ShiftRight<32>(both));
    return hn::TruncateTo(Packed(), hn::Or(both, hn::ShiftLeft<16>(upper)));
  }

  const BoxMeasure& measure_;
  alignas(16) std::array<float, 8> low_, scale_;
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
