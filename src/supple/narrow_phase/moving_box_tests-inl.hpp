// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_NARROW_PHASE_MOVING_BOX_TESTS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_NARROW_PHASE_MOVING_BOX_TESTS_INL_HPP
#undef SUPPLE_NARROW_PHASE_MOVING_BOX_TESTS_INL_HPP
#else
#define SUPPLE_NARROW_PHASE_MOVING_BOX_TESTS_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/packed_lanes-inl.hpp"
#include "narrow_phase/element_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One box at both ends of the step: min x, y, z, max x, y, z.
struct MovingBox {
  float start[6], end[6];
};

/// Six arrays of boxes at each end of the step, `stride` floats apart.
struct MovingBoxArrays {
  const float* start;
  const float* end;  ///< null where both objects are at rest
  std::size_t stride;
};

constexpr float greatest_bound = std::numeric_limits<float>::max();

/// Moves one side of boxes by the offset, and outward, in the direction `outward` (-1 or 1), by at least the
/// separation. Bounds stay within the range of float.
template <class Tag, class Vector = hn::Vec<Tag>>
HWY_INLINE Vector placed(Tag tag, Vector side, float offset, float separation, float outward) {
  side = hn::Add(side, hn::Set(tag, offset));
  if (separation > 0) {
    side = hn::Add(side, hn::Set(tag, outward * separation));
    // As `outward_step` of core/float_rounding.hpp.
    const Vector step = hn::Add(hn::Mul(hn::Abs(side), hn::Set(tag, 0x1p-23f)),
                                hn::Set(tag, std::numeric_limits<float>::min()));
    side = hn::Add(side, hn::Mul(hn::Set(tag, outward), step));
  }
  return hn::Min(hn::Max(side, hn::Set(tag, -greatest_bound)), hn::Set(tag, greatest_bound));
}

/// Bounds at a time between the two ends of the step. They are farther out, in the direction `outward` (-1 or
/// 1), than any rounding error. They stay within the range of float, so that an inverted box stays inverted.
/// A bound at the end of the range may be farther out, and so may be all bounds between it and another.
template <class Tag, class Vector = hn::Vec<Tag>>
HWY_INLINE Vector between(Tag tag, Vector start, Vector end, float time, float outward) {
  const Vector greatest = hn::Set(tag, greatest_bound), out = hn::Set(tag, outward);
  const Vector part = hn::Mul(end, hn::Set(tag, time));
  const Vector sizes = hn::Add(hn::Abs(start), hn::Abs(part));
  const Vector slack = hn::Min(hn::Mul(hn::Set(tag, 0x1p-21f), sizes), hn::Set(tag, greatest_bound / 4));
  const Vector bound = hn::Add(hn::Mul(start, hn::Set(tag, 1 - time)), part);
  const Vector moved = hn::Add(bound, hn::Mul(out, hn::Add(slack, hn::Set(tag, 0x1p-120f))));
  const auto is_at_end = hn::Ge(hn::Max(hn::Mul(start, out), hn::Mul(end, out)), greatest);
  return hn::IfThenElse(is_at_end, hn::Mul(greatest, out),
                        hn::Min(hn::Max(moved, hn::Neg(greatest)), greatest));
}

/// Moves boxes by `part.offset`, grows them by the separation, and replaces their end by that of the part of
/// the step. One of two objects is placed; the other is only shortened.
template <class Tag>
HWY_INLINE void place_and_shorten(Tag tag, float* start, float* end, int side, const PartOfStep& part) {
  const float outward = side < 3 ? -1.0f : 1.0f;
  auto at_start = hn::LoadU(tag, start), at_end = hn::LoadU(tag, end);
  if (part.separation > 0 || !(part.offset == Vec3f{})) {
    at_start = placed(tag, at_start, part.offset[side % 3], part.separation, outward);
    at_end = placed(tag, at_end, part.offset[side % 3], part.separation, outward);
  }
  if (part.latest < 1) at_end = between(tag, at_start, at_end, part.latest, outward);
  hn::StoreU(at_start, tag, start);
  hn::StoreU(at_end, tag, end);
}

/// The placed box of a child. Inverted boxes stay inverted.
HWY_NOINLINE MovingBox moving_box(const MovingBoxArrays& boxes, std::size_t i, const PartOfStep& part) {
  MovingBox box;
  for (std::size_t side = 0; side < 6; ++side) {
    box.start[side] = boxes.start[side * boxes.stride + i];
    box.end[side] = (boxes.end != nullptr ? boxes.end : boxes.start)[side * boxes.stride + i];
  }
  if (box.start[0] > greatest_bound || part.keeps_boxes()) return box;
  for (int side = 0; side < 6; ++side)
    place_and_shorten(hn::CappedTag<float, 1>(), box.start + side, box.end + side, side, part);
  return box;
}

/// Whether the ends of the step are the same or only its start counts.
HWY_INLINE bool are_at_rest(const MovingView& a, const MovingView& b, const PartOfStep& part) {
  return part.at_start || (a.start == a.end && b.start == b.end && !(part.latest < 1));
}

HWY_INLINE MovingBoxArrays child_boxes(const MovingView& view, std::uint32_t node, bool at_rest) {
  return {view.start[node].min_x, at_rest ? nullptr : view.end[node].min_x, node_width};
}

HWY_INLINE MovingBoxArrays arrays_of(const MovingBoxBlock& block, bool at_rest) {
  return {block.start[0], at_rest ? nullptr : block.end[0], leaf_block};
}

/// Whether a vector of boxes, from `first` on, is apart from `box` along the axis: on the same side at both
/// ends of the part of the step.
template <class Tag>
HWY_INLINE hn::Mask<Tag> apart_along(Tag tag, const MovingBox& box, const MovingBoxArrays& arrays,
                                     std::size_t first, std::size_t axis, float latest) {
  const float* const start = arrays.start + axis * arrays.stride + first;
  const std::size_t to_max = 3 * arrays.stride;
  const auto start_min = hn::LoadU(tag, start), start_max = hn::LoadU(tag, start + to_max);
  if (arrays.end == nullptr) {
    return hn::Or(hn::Gt(start_min, hn::Set(tag, box.start[axis + 3])),
                  hn::Lt(start_max, hn::Set(tag, box.start[axis])));
  }
  const float* const end = arrays.end + axis * arrays.stride + first;
  auto end_min = hn::LoadU(tag, end), end_max = hn::LoadU(tag, end + to_max);
  if (latest < 1) {
    end_min = between(tag, start_min, end_min, latest, -1.0f);
    end_max = between(tag, start_max, end_max, latest, 1.0f);
  }
  const auto above = hn::And(hn::Gt(start_min, hn::Set(tag, box.start[axis + 3])),
                             hn::Gt(end_min, hn::Set(tag, box.end[axis + 3])));
  const auto below =
      hn::And(hn::Lt(start_max, hn::Set(tag, box.start[axis])), hn::Lt(end_max, hn::Set(tag, box.end[axis])));
  return hn::Or(above, below);
}

/// Bits of a vector of boxes, from `first` on, that are not apart from `box` along any axis.
template <class Tag>
HWY_INLINE std::uint64_t meeting_bits(Tag tag, const MovingBox& box, const MovingBoxArrays& arrays,
                                      std::size_t first, float latest) {
  const auto apart = hn::Or(apart_along(tag, box, arrays, first, 0, latest),
                            hn::Or(apart_along(tag, box, arrays, first, 1, latest),
                                   apart_along(tag, box, arrays, first, 2, latest)));
  return mask_bits(tag, hn::Not(apart));
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
