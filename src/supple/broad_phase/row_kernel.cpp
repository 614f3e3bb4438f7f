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

#include "broad_phase/measure-inl.hpp"
#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint32_t, kMaxLanes>;

#if HWY_TARGET == HWY_SCALAR
using BoundLanes = Words;
using Bounds = hn::Vec<BoundLanes>;

/// Both halves of a word at once: how much more the ends of boxes are than the bounds that they must not
/// pass.
HWY_INLINE hn::Vec<Words> excess(const std::uint32_t* ends, Bounds bounds) {
  const std::uint32_t end = *ends, bound = hn::GetLane(bounds);
  const std::uint32_t low = (end & 0xffff) - std::min(end & 0xffff, bound & 0xffff);
  const std::uint32_t high = (end >> 16) - std::min(end >> 16, bound >> 16);
  return hn::Set(Words(), low | high << 16);
}
#else
using BoundLanes = hn::Repartition<std::uint16_t, Words>;
using Bounds = hn::Vec<BoundLanes>;

/// Both halves of a word at once: how much more the ends of boxes are than the bounds that they must not
/// pass.
HWY_INLINE hn::Vec<Words> excess(const std::uint32_t* ends, Bounds bounds) {
  const auto halves = hn::LoadU(BoundLanes(), reinterpret_cast<const std::uint16_t*>(ends));
  return hn::BitCast(Words(), hn::SaturatedSub(halves, bounds));
}
#endif

void flush(std::span<const BoundingSphere> spheres, std::size_t count, RowSearch& search) {
  if (!spheres.empty()) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t a = search.first[i], b = search.second[i];
      search.first[kept] = a;
      search.second[kept] = b;
      kept += static_cast<std::size_t>(overlap(spheres[a], spheres[b]));
    }
    count = kept;
  }
  search.pairs->push_all(search.first.data(), search.second.data(), count);
}

/// The arrays that are read and written all the time; by value, as the compiler takes each word that is
/// written for a change of any other.
struct Arrays {
  const std::uint32_t* ends_0;
  const std::uint32_t* ends_1;
  const std::uint32_t* ends_2;
  const std::uint32_t* slots;
  std::uint32_t* first;
  std::uint32_t* second;
  std::size_t count = 0;  // of pairs
  std::uint64_t tests = 0;
};

/// One box: what the ends of others must not pass, less one in each half.
struct Row {
  Bounds bounds_0, bounds_1, bounds_2;
  std::uint32_t slot;
  std::array<std::uint32_t, 3> low, high;
};

HWY_INLINE Row row_of(const Arrays& arrays, std::size_t place) {
  const Words lanes;
  const std::uint32_t x = arrays.ends_0[place], y = arrays.ends_1[place], z = arrays.ends_2[place];
  const auto bounds = [&](std::uint32_t ends) HWY_ATTR {
    return hn::BitCast(BoundLanes(), hn::Set(lanes, ~std::rotl(ends, 16) - 0x00010001u));
  };
  return {bounds(x),
          bounds(y),
          bounds(z),
          arrays.slots[place],
          {x & 0xffff, y & 0xffff, z & 0xffff},
          {0xffff - (x >> 16), 0xffff - (y >> 16), 0xffff - (z >> 16)}};
}

/// Of boxes from `j` on, those whose lanes are set overlap a box perhaps. Returns the number of pairs then.
HWY_NOINLINE std::size_t decide(const DealtBoxes& boxes, std::uint32_t slot, std::size_t j,
                                std::uint32_t undecided, std::size_t count, RowSearch& search) {
  for (; undecided != 0; undecided &= undecided - 1) {
    const std::uint32_t other = boxes.slots[j + static_cast<std::size_t>(std::countr_zero(undecided))];
    search.first[count] = slot;
    search.second[count] = other;
    count += static_cast<std::size_t>(overlap(boxes.exact[slot], boxes.exact[other]));
  }
  return count;
}

template <class Mask>
std::uint32_t bits_of(Mask mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(Words(), mask, bytes.data());
  return bytes[0] + 256u * bytes[1];
}

/// A row against boxes [begin, end). Nothing is left of an end that is surely within its bound, 1 of one that
/// is in the same step. Where pairs are `dense` there is no branch on whether there are any.
template <bool dense>
HWY_INLINE void against(const Row& row, std::size_t begin, std::size_t end, const DealtBoxes& boxes,
                        Arrays& arrays, RowSearch& search) {
  const Words lanes;
  arrays.tests += end - begin;
  for (std::size_t j = begin; j < end; j += hn::Lanes(lanes)) {
    const auto over =
        hn::Or(hn::Or(excess(arrays.ends_0 + j, row.bounds_0), excess(arrays.ends_1 + j, row.bounds_1)),
               excess(arrays.ends_2 + j, row.bounds_2));
    const auto apart = hn::And(over, hn::Set(lanes, 0xfffefffeu));
    if constexpr (!dense) {
      if (HWY_LIKELY(hn::AllFalse(lanes, hn::Eq(apart, hn::Zero(lanes))))) continue;
    }
    const auto in_range = hn::FirstN(lanes, end - j);
    const auto sure = hn::And(in_range, hn::Eq(over, hn::Zero(lanes)));
    const auto undecided = hn::AndNot(sure, hn::And(in_range, hn::Eq(apart, hn::Zero(lanes))));
    hn::StoreU(hn::Set(lanes, row.slot), lanes, arrays.first + arrays.count);
    hn::StoreU(packed_lanes(lanes, hn::LoadU(lanes, arrays.slots + j), sure), lanes,
               arrays.second + arrays.count);
    arrays.count += hn::CountTrue(lanes, sure);
    if (HWY_UNLIKELY(!hn::AllFalse(lanes, undecided)))
      arrays.count = decide(boxes, row.slot, j, bits_of(undecided), arrays.count, search);
    if (HWY_UNLIKELY(arrays.count > RowSearch::kBatch)) {
      flush(boxes.spheres, arrays.count, search);
      arrays.count = 0;
    }
  }
}

/// Divisions of one axis in which boxes of a level may begin that this one meets.
struct Span {
  std::uint32_t first, last;
};
HWY_INLINE Span span_of(const BoxRows& rows, const Row& row, std::size_t axis) {
  const std::uint32_t low = row.low[axis], reach = rows.reach[axis];
  return {rows.division(axis, low - std::min(low, reach)), rows.division(axis, row.high[axis])};
}

/// Calls for the range of places in each row.
template <class Visit>
HWY_INLINE void for_rows(const std::uint32_t* cell_begins, const BoxRows& rows, Span cells, Span second,
                         Span third, const Visit& visit) {
  for (std::uint32_t k = third.first; k <= third.last; ++k) {
    const std::uint32_t* begins =
        cell_begins + rows.first_cell + std::size_t{k * rows.divisions[1] + second.first} * rows.divisions[0];
    for (std::uint32_t i = second.first; i <= second.last; ++i, begins += rows.divisions[0])
      visit(begins[cells.first], begins[cells.last + 1]);
  }
}

/// The level and block of a box.
HWY_INLINE void deal(const BoxMeasure& measure, std::span<const BoxRows> levels, std::size_t i,
                     const MeasuredBoxes& out) {
  const MeasuredBox& box = out.boxes[i];
  std::array<std::uint32_t, 4> extents;
  for (std::size_t axis = 0; axis < 3; ++axis)
    extents[axis] = 0xffff - (box.ends[axis] >> 16) - (box.ends[axis] & 0xffff);
  const std::size_t level = measure.level_of(extents);
  const BoxRows& rows = levels[level];
  for (std::size_t axis = 0; axis < 3; ++axis)
    out.reach[level][axis] = std::max(out.reach[level][axis], extents[axis]);
  const std::uint32_t row = rows.row_of(measure.low_step(box, 1), measure.low_step(box, 2));
  const std::uint32_t block = measure.first_block[level] + (row >> measure.rows_per_block_log2[level]);
  out.blocks[i] = block;
  ++out.block_sizes[block];
}

std::size_t measure(const BoxMeasure& measure, std::span<const BoxRows> levels, std::span<const Aabb> boxes,
                    std::uint32_t slot, const MeasuredBoxes& out) {
  const Measure of_box(measure);
  Measure::Reach reach = Measure::Reach::nothing();
  const bool one_block = measure.first_block.back() == 1;
  const std::uint32_t before = out.block_sizes[0];
  const std::size_t batch = of_box.batch();
  std::size_t count = 0;
  for (std::size_t i = 0; i < boxes.size();) {
    const auto first = slot + static_cast<std::uint32_t>(i);
    if (i + batch <= boxes.size() && of_box.many(&boxes[i], first, out.boxes + count, reach)) {
      for (std::size_t k = 0; k < batch && !one_block; ++k) deal(measure, levels, count + k, out);
      i += batch;
      count += batch;
      continue;
    }
    for (const std::size_t end = std::min(i + batch, boxes.size()); i < end; ++i) {
      std::array<std::uint32_t, 4> extents;
      const bool is_box = of_box.ends(boxes[i], out.boxes[count], extents);
      out.boxes[count].slot = slot + static_cast<std::uint32_t>(i);
      if (is_box) deal(measure, levels, count++, out);
    }
  }
  if (!one_block) return count;
  // What was left of the only block when boxes were measured many at a time.
  std::fill_n(out.blocks, count, 0);
  out.block_sizes[0] = before + static_cast<std::uint32_t>(count);
  const std::array<std::uint32_t, 3> largest = reach.largest();
  for (std::size_t axis = 0; axis < 3; ++axis)
    out.reach[0][axis] = std::max(out.reach[0][axis], largest[axis]);
  return count;
}

#if HWY_TARGET != HWY_SCALAR
constexpr std::size_t kRowsAtOnce = 4;

/// The boxes [place, place + 4) of the only row against those behind each of them, where few overlap: a
/// vector of others is loaded once for four, and there is one branch for all.
HWY_INLINE void search_four(const DealtBoxes& boxes, std::size_t place, Arrays& arrays, RowSearch& search) {
  const Words lanes;
  const std::uint32_t* const cell_begins = boxes.cell_begins.data();
  const Row row_0 = row_of(arrays, place), row_1 = row_of(arrays, place + 1),
            row_2 = row_of(arrays, place + 2), row_3 = row_of(arrays, place + 3);
  std::size_t end = 0;
  const auto end_of = [&](const Row& row, std::size_t own) HWY_ATTR {
    const std::size_t own_end = cell_begins[boxes.levels[0].division(0, row.high[0]) + 1];
    arrays.tests += own_end - own - 1;
    end = std::max(end, own_end);
  };
  end_of(row_0, place);
  end_of(row_1, place + 1);
  end_of(row_2, place + 2);
  end_of(row_3, place + 3);
  const auto apart_by = [&](const Row& row, std::size_t j) HWY_ATTR {
    const auto over =
        hn::Or(hn::Or(excess(arrays.ends_0 + j, row.bounds_0), excess(arrays.ends_1 + j, row.bounds_1)),
               excess(arrays.ends_2 + j, row.bounds_2));
    return hn::And(over, hn::Set(lanes, 0xfffefffeu));
  };
  // Those that are not behind a row are far from it.
  const auto none_of = [&](std::size_t k) HWY_ATTR { return hn::VecFromMask(lanes, hn::FirstN(lanes, k)); };
  auto hide_1 = none_of(1), hide_2 = none_of(2), hide_3 = none_of(3);
  for (std::size_t j = place + 1; j < end; j += hn::Lanes(lanes)) {
    const auto apart_0 = apart_by(row_0, j), apart_1 = hn::Or(apart_by(row_1, j), hide_1),
               apart_2 = hn::Or(apart_by(row_2, j), hide_2), apart_3 = hn::Or(apart_by(row_3, j), hide_3);
    hide_1 = hide_2 = hide_3 = hn::Zero(lanes);
    const auto least = hn::Min(hn::Min(apart_0, apart_1), hn::Min(apart_2, apart_3));
    if (HWY_LIKELY(hn::AllFalse(lanes, hn::Eq(least, hn::Zero(lanes))))) continue;
    const auto near_of = [&](hn::Vec<Words> apart)
                             HWY_ATTR -> std::uint64_t { return bits_of(hn::Eq(apart, hn::Zero(lanes))); };
    const std::uint64_t in_range = end - j < 16 ? (1u << (end - j)) - 1 : 0xffff;
    std::uint64_t near =
        near_of(apart_0) | near_of(apart_1) << 16 | near_of(apart_2) << 32 | near_of(apart_3) << 48;
    near &= in_range * 0x0001000100010001u;
    for (; near != 0; near &= near - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(near));
      const std::uint32_t slot = arrays.slots[place + bit / 16], other = arrays.slots[j + bit % 16];
      arrays.first[arrays.count] = slot;
      arrays.second[arrays.count] = other;
      arrays.count += static_cast<std::size_t>(overlap(boxes.exact[slot], boxes.exact[other]));
    }
    if (HWY_UNLIKELY(arrays.count > RowSearch::kBatch - 4 * kMaxLanes)) {
      flush(boxes.spheres, arrays.count, search);
      arrays.count = 0;
    }
  }
}
#endif

template <bool dense, bool only_row>
void search_level(const DealtBoxes& boxes, std::size_t level, std::size_t begin, std::size_t end,
                  RowSearch& search) {
  Arrays arrays{boxes.ends[0].data(), boxes.ends[1].data(), boxes.ends[2].data(),
                boxes.slots.data(),   search.first.data(),  search.second.data()};
  const std::uint32_t* const cell_begins = boxes.cell_begins.data();
  const BoxRows rows = boxes.levels[level];
  std::size_t place = begin;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (only_row && !dense)
    for (; place + kRowsAtOnce <= end; place += kRowsAtOnce) search_four(boxes, place, arrays, search);
#endif
  for (; place < end; ++place) {
    const Row row = row_of(arrays, place);
    const auto visit = [&](std::size_t from, std::size_t to)
                           HWY_ATTR { against<dense>(row, from, to, boxes, arrays, search); };
    if constexpr (only_row) {
      visit(place + 1, cell_begins[rows.division(0, row.high[0]) + 1]);
      continue;
    }
    const Span cells = span_of(rows, row, 0), second = span_of(rows, row, 1);
    const std::uint32_t own_second = rows.division(1, row.low[1]), own_third = rows.division(2, row.low[2]);
    const std::size_t own_row = std::size_t{own_third * rows.divisions[1] + own_second} * rows.divisions[0];
    visit(place + 1, cell_begins[rows.first_cell + own_row + cells.last + 1]);
    for_rows(cell_begins, rows, cells, {own_second + 1, second.last}, {own_third, own_third}, visit);
    for_rows(cell_begins, rows, cells, second, {own_third + 1, rows.division(2, row.high[2])}, visit);
    for (std::size_t smaller = 0; smaller < level; ++smaller) {
      const BoxRows& others = boxes.levels[smaller];
      for_rows(cell_begins, others, span_of(others, row, 0), span_of(others, row, 1), span_of(others, row, 2),
               visit);
    }
  }
  flush(boxes.spheres, arrays.count, search);
  search.tests += arrays.tests;
}

void search(const DealtBoxes& boxes, std::size_t level, std::size_t begin, std::size_t end,
            RowSearch& row_search) {
  const bool only_row = boxes.levels.size() == 1 && boxes.levels[0].row_count() == 1;
  if (only_row && boxes.is_dense)
    search_level<true, true>(boxes, level, begin, end, row_search);
  else if (only_row)
    search_level<false, true>(boxes, level, begin, end, row_search);
  else if (boxes.is_dense)
    search_level<true, false>(boxes, level, begin, end, row_search);
  else
    search_level<false, false>(boxes, level, begin, end, row_search);
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
