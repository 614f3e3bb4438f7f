#include "broad_phase/row_kernel.hpp"

#include <algorithm>
#include <bit>

#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"

// Highway compiles the rest of this file once for each instruction set, and picks one when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "broad_phase/row_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint32_t, kMaxLanes>;

/// Both halves of a word at once: how much more a box's end is than the bound that it must not pass.
template <class Vector>
HWY_INLINE Vector excess(Vector ends, Vector bounds) {
#if HWY_TARGET == HWY_SCALAR
  const Words lanes;
  const std::uint32_t end = hn::GetLane(ends), bound = hn::GetLane(bounds);
  const std::uint32_t low = (end & 0xffff) - std::min(end & 0xffff, bound & 0xffff);
  const std::uint32_t high = (end >> 16) - std::min(end >> 16, bound >> 16);
  return hn::Set(lanes, low | high << 16);
#else
  const hn::Repartition<std::uint16_t, Words> halves;
  return hn::BitCast(Words(), hn::SaturatedSub(hn::BitCast(halves, ends), hn::BitCast(halves, bounds)));
#endif
}

void flush(std::span<const BoundingSphere> spheres, std::size_t count, RowSearch& search) {
  PairBins& pairs = *search.pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = std::min(search.first[i], search.second[i]);
    const std::uint32_t b = std::max(search.first[i], search.second[i]);
    if (!spheres.empty() && !overlap(spheres[a], spheres[b])) continue;
    pairs.push({a, b});
  }
}

/// One box against others.
class Row {
 public:
  HWY_INLINE Row(const DealtBoxes& boxes, RowSearch& search) : boxes_(boxes), search_(search) {}

  HWY_INLINE void begin(std::size_t place) {
    place_ = place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t ends = boxes_.ends[axis][place];
      low_[axis] = ends & 0xffff;
      high_[axis] = 0xffff - (ends >> 16);
    }
  }
  std::uint32_t low(std::size_t axis) const { return low_[axis]; }
  std::uint32_t high(std::size_t axis) const { return high_[axis]; }

  /// One less than the bounds of each half.
  HWY_INLINE hn::Vec<Words> bounds(std::size_t axis) const {
    return hn::Set(Words(), ~std::rotl(boxes_.ends[axis][place_], 16) - 0x00010001u);
  }

  /// Against boxes [begin, end). One less than the bounds: 0 is left of an end that is surely within, 1 of
  /// one in the same step.
  HWY_INLINE void against(std::size_t begin, std::size_t end) {
    const Words lanes;
    tests_ += end - begin;
    const auto bounds_0 = bounds(0), bounds_1 = bounds(1), bounds_2 = bounds(2);
    const auto slot = hn::Set(lanes, boxes_.slots[place_]);
    const auto zero = hn::Zero(lanes);
    for (std::size_t j = begin; j < end; j += hn::Lanes(lanes)) {
      const auto over = hn::Or(hn::Or(excess(hn::LoadU(lanes, boxes_.ends[0].data() + j), bounds_0),
                                      excess(hn::LoadU(lanes, boxes_.ends[1].data() + j), bounds_1)),
                               excess(hn::LoadU(lanes, boxes_.ends[2].data() + j), bounds_2));
      const auto in_range = hn::FirstN(lanes, end - j);
      const auto sure = hn::And(in_range, hn::Eq(over, zero));
      const auto possible = hn::And(in_range, hn::Eq(hn::And(over, hn::Set(lanes, 0xfffefffeu)), zero));
      hn::StoreU(slot, lanes, search_.first.data() + count_);
      hn::StoreU(hn::Compress(hn::LoadU(lanes, boxes_.slots.data() + j), sure), lanes,
                 search_.second.data() + count_);
      count_ += hn::CountTrue(lanes, sure);
      if (HWY_UNLIKELY(!hn::AllFalse(lanes, hn::AndNot(sure, possible))))
        decide(j, hn::AndNot(sure, possible));
      if (HWY_UNLIKELY(count_ > RowSearch::kBatch)) hand_over();
    }
  }
  void hand_over() {
    flush(boxes_.spheres, count_, search_);
    count_ = 0;
  }
  void end() {
    hand_over();
    search_.tests += tests_;
  }

 private:
  template <class Mask>
  HWY_NOINLINE void decide(std::size_t j, Mask undecided) {
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(Words(), undecided, bytes.data());
    const std::uint32_t slot = boxes_.slots[place_];
    for (std::uint32_t bits = bytes[0] + 256u * bytes[1]; bits != 0; bits &= bits - 1) {
      const std::uint32_t other = boxes_.slots[j + static_cast<std::size_t>(std::countr_zero(bits))];
      search_.first[count_] = slot;
      search_.second[count_] = other;
      count_ += static_cast<std::size_t>(overlap(boxes_.exact[slot], boxes_.exact[other]));
    }
  }

  const DealtBoxes& boxes_;
  RowSearch& search_;
  std::size_t place_ = 0, count_ = 0;
  std::uint64_t tests_ = 0;
  std::array<std::uint32_t, 3> low_{}, high_{};
};

/// Divisions of one axis in which boxes of a level may begin that this one meets.
struct Span {
  std::uint32_t first, last;
};
HWY_INLINE Span span_of(const BoxRows& rows, const Row& row, std::size_t axis) {
  const std::uint32_t low = row.low(axis), reach = rows.reach[axis];
  return {rows.division(axis, low - std::min(low, reach)), rows.division(axis, row.high(axis))};
}

HWY_INLINE void against_rows(const DealtBoxes& boxes, const BoxRows& rows, Span cells, Span second,
                             std::uint32_t third, Row& row) {
  const std::uint32_t* begins = boxes.cell_begins.data() + rows.first_cell +
                                std::size_t{third * rows.divisions[1] + second.first} * rows.divisions[0];
  for (std::uint32_t i = second.first; i <= second.last; ++i, begins += rows.divisions[0])
    row.against(begins[cells.first], begins[cells.last + 1]);
}

#if HWY_TARGET == HWY_SCALAR
std::uint32_t step_of(float value, float low, float steps_per_unit) {
  return static_cast<std::uint32_t>(std::clamp((value - low) * steps_per_unit, 1.0f, kSteps - 2.0f));
}

/// Ends of a box in steps, or false when it is empty.
bool measure_ends(const BoxMeasure& measure, const Aabb& box, MeasuredBox& out,
                  std::array<std::uint32_t, 4>& extents) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int k = static_cast<int>(axis);
    const std::uint32_t low = step_of(box.min[k], measure.low[axis], measure.steps_per_unit[axis]);
    const std::uint32_t high = step_of(box.max[k], measure.low[axis], measure.steps_per_unit[axis]);
    out.ends[axis] = low | (0xffff - high) << 16;
    extents[axis] = high - low;
  }
  return !box.empty();
}
#else
/// Ends of a box in steps, or false when it is empty. The box is loaded as its first four and its last four
/// numbers.
HWY_INLINE bool measure_ends(const BoxMeasure& measure, const Aabb& box, MeasuredBox& out,
                             std::array<std::uint32_t, 4>& extents) {
  const hn::Full128<float> floats;
  const hn::Full128<std::int32_t> signed_words;
  const hn::Full128<std::uint32_t> words;
  const auto& [low_x, low_y, low_z] = measure.low;
  const auto& [scale_x, scale_y, scale_z] = measure.steps_per_unit;
  alignas(16) const std::array<float, 8> low{low_x, low_y, low_z, low_x, low_z, low_x, low_y, low_z};
  alignas(16) const std::array<float, 8> scale{scale_x, scale_y, scale_z, scale_x,
                                               scale_z, scale_x, scale_y, scale_z};
  const auto steps = [&](auto values, std::size_t i) HWY_ATTR {
    const auto place =
        hn::Mul(hn::Sub(values, hn::Load(floats, low.data() + i)), hn::Load(floats, scale.data() + i));
    const auto clamped = hn::Min(hn::Max(place, hn::Set(floats, 1.0f)), hn::Set(floats, kSteps - 2.0f));
    return hn::BitCast(words, hn::ConvertTo(signed_words, clamped));
  };
  const auto mins = hn::LoadU(floats, &box.min.x);      // and max x
  const auto end_part = hn::LoadU(floats, &box.min.z);  // then max
  const auto maxes = hn::Shuffle0321(end_part);
  const auto first = steps(mins, 0), last = hn::Shuffle0321(steps(end_part, 4));
  const auto ends = hn::Or(first, hn::ShiftLeft<16>(hn::Sub(hn::Set(words, 0xffffu), last)));
  hn::Store(ends, words, out.ends.data());
  hn::StoreU(hn::Sub(last, first), words, extents.data());
  std::array<std::uint8_t, 8> not_empty{};
  hn::StoreMaskBits(floats, hn::Le(mins, maxes), not_empty.data());
  return (not_empty[0] & 7) == 7;
}
#endif

std::size_t measure(const BoxMeasure& measure, std::span<const BoxRows> levels, std::span<const Aabb> boxes,
                    std::uint32_t slot, const MeasuredBoxes& out) {
  std::size_t count = 0;
  for (const Aabb& box : boxes) {
    MeasuredBox& measured = out.boxes[count];
    std::array<std::uint32_t, 4> extents;
    const bool is_box = measure_ends(measure, box, measured, extents);
    measured.slot = slot++;
    if (!is_box) continue;
    std::size_t level = 0;
    for (; level + 1 < levels.size(); ++level) {
      const auto& largest = measure.largest[level];
      if (extents[0] <= largest[0] && extents[1] <= largest[1] && extents[2] <= largest[2]) break;
    }
    const BoxRows& rows = levels[level];
    for (std::size_t axis = 0; axis < 3; ++axis)
      out.reach[level][axis] = std::max(out.reach[level][axis], extents[axis]);
    const std::uint32_t row = rows.row_of(measure.low_step(measured, 1), measure.low_step(measured, 2));
    const std::uint32_t block = measure.first_block[level] + (row >> measure.rows_per_block_log2[level]);
    out.blocks[count++] = block;
    ++out.block_sizes[block];
  }
  return count;
}

void search(const DealtBoxes& boxes, std::size_t level, std::size_t begin, std::size_t end,
            RowSearch& search) {
  Row row(boxes, search);
  const BoxRows& rows = boxes.levels[level];
  for (std::size_t place = begin; place < end; ++place) {
    row.begin(place);
    const Span cells = span_of(rows, row, 0), second = span_of(rows, row, 1);
    const std::uint32_t own_second = rows.division(1, row.low(1)), own_third = rows.division(2, row.low(2));
    const std::uint32_t own_row = rows.row_of(row.low(1), row.low(2));
    row.against(
        place + 1,
        boxes.cell_begins[rows.first_cell + std::size_t{own_row} * rows.divisions[0] + cells.last + 1]);
    if (second.last > own_second)
      against_rows(boxes, rows, cells, {own_second + 1, second.last}, own_third, row);
    const std::uint32_t last_third = rows.division(2, row.high(2));
    for (std::uint32_t third = own_third + 1; third <= last_third; ++third)
      against_rows(boxes, rows, cells, second, third, row);
    for (std::size_t smaller = 0; smaller < level; ++smaller) {
      const BoxRows& others = boxes.levels[smaller];
      const Span thirds = span_of(others, row, 2);
      for (std::uint32_t third = thirds.first; third <= thirds.last; ++third)
        against_rows(boxes, others, span_of(others, row, 0), span_of(others, row, 1), third, row);
    }
  }
  row.end();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(search);
HWY_EXPORT(measure);

std::size_t measure_boxes(const BoxMeasure& box_measure, std::span<const BoxRows> levels,
                          std::span<const Aabb> boxes, std::uint32_t slot, const MeasuredBoxes& out) {
  return HWY_DYNAMIC_DISPATCH(measure)(box_measure, levels, boxes, slot, out);
}

void search_rows(const DealtBoxes& boxes, std::size_t level, std::size_t begin, std::size_t end,
                 RowSearch& row_search) {
  HWY_DYNAMIC_DISPATCH(search)(boxes, level, begin, end, row_search);
}

}  // namespace supple
#endif
