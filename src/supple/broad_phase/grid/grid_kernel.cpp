#include "broad_phase/grid/grid_kernel.hpp"

#include <algorithm>
#include <bit>

#include "broad_phase/pair_sorter.hpp"
#include "geometry/aabb.hpp"

// Highway compiles the rest of this file once for each instruction set, and picks one when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "broad_phase/grid/grid_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint32_t, max_lanes>;

#if HWY_TARGET == HWY_SCALAR
using BoundLanes = Words;
using Bounds = hn::Vec<BoundLanes>;

/// By how many steps the ends of boxes exceed their bounds, for both halves of each word.
HWY_INLINE hn::Vec<Words> excess(const std::uint32_t* ends, Bounds bounds) {
  const std::uint32_t end = *ends, bound = hn::GetLane(bounds);
  const std::uint32_t low = (end & 0xffff) - std::min(end & 0xffff, bound & 0xffff);
  const std::uint32_t high = (end >> 16) - std::min(end >> 16, bound >> 16);
  return hn::Set(Words(), low | high << 16);
}
#else
using BoundLanes = hn::Repartition<std::uint16_t, Words>;
using Bounds = hn::Vec<BoundLanes>;

/// By how many steps the ends of boxes exceed their bounds, for both halves of each word.
HWY_INLINE hn::Vec<Words> excess(const std::uint32_t* ends, Bounds bounds) {
  const auto halves = hn::LoadU(BoundLanes(), reinterpret_cast<const std::uint16_t*>(ends));
  return hn::BitCast(Words(), hn::SaturatedSub(halves, bounds));
}
#endif

/// Copies of what the inner loop uses. Otherwise the compiler reloads it after each store.
struct Arrays {
  const std::uint32_t* ends_0;
  const std::uint32_t* ends_1;
  const std::uint32_t* ends_2;
  const std::uint32_t* slots;
  std::uint32_t* first;
  std::uint32_t* second;
  bool many_pairs;
  std::size_t count = 0;  // of pairs
  std::uint64_t tests = 0;
};

/// One box: the bounds of the ends of other boxes, minus one in each half, and its steps by grid axis.
struct Query {
  Bounds bounds_0, bounds_1, bounds_2;
  std::uint32_t slot;
  std::array<std::uint32_t, 3> low, high;
};

HWY_INLINE Query query_of(const Arrays& arrays, std::size_t place) {
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

/// Adds the pairs of a box with the boxes of set lanes, counted from `j`, that overlap exactly.
HWY_NOINLINE std::size_t decide(const BinnedBoxes& boxes, std::uint32_t slot, std::size_t j,
                                std::uint32_t undecided, std::size_t count, PairList& pairs) {
  for (; undecided != 0; undecided &= undecided - 1) {
    const std::uint32_t other = boxes.slots[j + static_cast<std::size_t>(std::countr_zero(undecided))];
    pairs.first[count] = slot;
    pairs.second[count] = other;
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

/// Tests a box against boxes [begin, end). The excess of an end is 0 when the end is surely within its bound,
/// and 1 when both are in the same step.
HWY_INLINE void test(const Query& query, std::size_t begin, std::size_t end, const BinnedBoxes& boxes,
                     Arrays& arrays, PairList& pairs) {
  const Words lanes;
  arrays.tests += end - begin;
  for (std::size_t j = begin; j < end; j += hn::Lanes(lanes)) {
    const auto over =
        hn::Or(hn::Or(excess(arrays.ends_0 + j, query.bounds_0), excess(arrays.ends_1 + j, query.bounds_1)),
               excess(arrays.ends_2 + j, query.bounds_2));
    const auto apart = hn::And(over, hn::Set(lanes, 0xfffefffeu));
    // When most vectors contain a pair, this branch would be unpredictable.
    if (HWY_LIKELY(!arrays.many_pairs && hn::AllFalse(lanes, hn::Eq(apart, hn::Zero(lanes))))) continue;
    const auto in_range = hn::FirstN(lanes, end - j);
    const auto sure = hn::And(in_range, hn::Eq(over, hn::Zero(lanes)));
    const auto undecided = hn::AndNot(sure, hn::And(in_range, hn::Eq(apart, hn::Zero(lanes))));
    hn::StoreU(hn::Set(lanes, query.slot), lanes, arrays.first + arrays.count);
    hn::StoreU(packed_lanes(lanes, hn::LoadU(lanes, arrays.slots + j), sure), lanes,
               arrays.second + arrays.count);
    arrays.count += hn::CountTrue(lanes, sure);
    if (HWY_UNLIKELY(!hn::AllFalse(lanes, undecided)))
      arrays.count = decide(boxes, query.slot, j, bits_of(undecided), arrays.count, pairs);
    if (HWY_UNLIKELY(arrays.count > PairList::batch_size)) {
      pairs.flush(arrays.count, boxes.spheres);
      arrays.count = 0;
    }
  }
}

/// The divisions of one axis in which boxes may begin that overlap the query.
struct Divisions {
  std::uint32_t first, last;
};
HWY_INLINE Divisions divisions_of(const GridLevel& level, const Query& query, std::size_t axis) {
  const std::uint32_t low = query.low[axis], max_extent = level.max_extent[axis];
  return {level.division(axis, low - std::min(low, max_extent)), level.division(axis, query.high[axis])};
}

/// Calls `visit` for the range of boxes in each row.
template <class Visit>
HWY_INLINE void for_rows(const std::uint32_t* cell_begins, const GridLevel& level, Divisions cells,
                         Divisions second, Divisions third, const Visit& visit) {
  for (std::uint32_t k = third.first; k <= third.last; ++k) {
    const std::size_t row = std::size_t{k * level.divisions[1] + second.first} * level.divisions[0];
    const std::uint32_t* begins = cell_begins + level.first_cell + row;
    for (std::uint32_t i = second.first; i <= second.last; ++i, begins += level.divisions[0])
      visit(begins[cells.first], begins[cells.last + 1]);
  }
}

/// Without `tests_own_level`, the boxes are only tested against those of other levels.
template <bool only_row, bool tests_own_level>
std::uint64_t search_level(const Grid& grid, const BinnedBoxes& boxes, std::size_t level_index,
                           std::size_t begin, std::size_t end, PairList& pairs) {
  Arrays arrays{boxes.ends[0].data(), boxes.ends[1].data(), boxes.ends[2].data(), boxes.slots.data(),
                pairs.first.data(),   pairs.second.data(),  boxes.has_many_pairs};
  const std::uint32_t* const cell_begins = boxes.cell_begins.data();
  const GridLevel level = grid.levels[level_index];
  const std::uint32_t other_levels = level.tested_levels & ~(1u << level_index);
  for (std::size_t place = begin; place < end; ++place) {
    const Query query = query_of(arrays, place);
    const auto visit = [&](std::size_t from, std::size_t to)
                           HWY_ATTR { test(query, from, to, boxes, arrays, pairs); };
    if constexpr (only_row) {
      visit(place + 1, cell_begins[level.division(0, query.high[0]) + 1]);
      continue;
    }
    if constexpr (tests_own_level) {
      const Divisions cells = divisions_of(level, query, 0), second = divisions_of(level, query, 1);
      const std::uint32_t own_second = level.division(1, query.low[1]);
      const std::uint32_t own_third = level.division(2, query.low[2]);
      const std::size_t own_row =
          std::size_t{own_third * level.divisions[1] + own_second} * level.divisions[0];
      visit(place + 1, cell_begins[level.first_cell + own_row + cells.last + 1]);
      for_rows(cell_begins, level, cells, {own_second + 1, second.last}, {own_third, own_third}, visit);
      for_rows(cell_begins, level, cells, second, {own_third + 1, level.division(2, query.high[2])}, visit);
    }
    for (std::uint32_t rest = other_levels; rest != 0; rest &= rest - 1) {
      const GridLevel& others = grid.levels[static_cast<std::size_t>(std::countr_zero(rest))];
      for_rows(cell_begins, others, divisions_of(others, query, 0), divisions_of(others, query, 1),
               divisions_of(others, query, 2), visit);
    }
  }
  pairs.flush(arrays.count, boxes.spheres);
  return arrays.tests;
}

std::uint64_t search(const Grid& grid, const BinnedBoxes& boxes, std::size_t level, std::size_t begin,
                     std::size_t end, PairList& pairs) {
  const bool tests_own_level = (grid.levels[level].tested_levels >> level & 1) != 0;
  const auto function = grid.is_one_row() ? search_level<true, true>
                        : tests_own_level ? search_level<false, true>
                                          : search_level<false, false>;
  return function(grid, boxes, level, begin, end, pairs);
}

/// Quantizes all coordinates of boxes. Adding 2^23 to a float leaves its whole number in the lower bits.
/// `steps` has room for a vector past the last step. NaN, which only empty boxes have, may become any step.
void steps_of(const Grid& grid, std::span<const float> coordinates, std::uint32_t* steps) {
  constexpr std::size_t period = 3 * max_lanes;  // a multiple of 3 and of every vector length
  const hn::CappedTag<float, max_lanes> lanes;
  const Words words;
  std::array<float, period> low, scale;
  for (std::size_t i = 0; i < period; ++i) {
    low[i] = grid.low[i % 3];
    scale[i] = grid.steps_per_unit[i % 3];
  }
  std::array<float, max_lanes> tail{};
  for (std::size_t i = 0; i < coordinates.size(); i += hn::Lanes(lanes)) {
    const float* values = coordinates.data() + i;
    if (const std::size_t left = coordinates.size() - i; left < hn::Lanes(lanes)) {
      std::copy_n(values, left, tail.data());
      values = tail.data();
    }
    const auto place = hn::Mul(hn::Sub(hn::LoadU(lanes, values), hn::LoadU(lanes, low.data() + i % period)),
                               hn::LoadU(lanes, scale.data() + i % period));
    const auto inside = hn::Min(hn::Max(place, hn::Set(lanes, 1.0f)),
                                hn::Set(lanes, static_cast<float>(quantization_steps - 2)));
    hn::StoreU(hn::And(hn::BitCast(words, hn::Add(inside, hn::Set(lanes, 0x1p23f))), hn::Set(words, 0xffffu)),
               words, steps + i);
  }
}

std::size_t quantize(const Grid& grid, std::span<const Aabb> boxes, std::uint32_t slot, QuantizedBox* out) {
  static_assert(sizeof(Aabb) == 6 * sizeof(float));
  constexpr std::size_t batch_size = 128;
  std::array<std::uint32_t, 6 * batch_size + max_lanes> steps;
  QuantizedBox* const first = out;
  for (std::size_t begin = 0; begin < boxes.size(); begin += batch_size) {
    const auto batch = boxes.subspan(begin, std::min(batch_size, boxes.size() - begin));
    steps_of(grid, {&batch.front().min.x, 6 * batch.size()}, steps.data());
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const std::uint32_t* const ends = steps.data() + 6 * i;
      for (std::size_t k = 0; k < 3; ++k) out->ends[k] = ends[k] | (0xffff - ends[k + 3]) << 16;
      out->slot = slot++;
      out += !batch[i].empty();
    }
  }
  return static_cast<std::size_t>(out - first);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(search);
HWY_EXPORT(quantize);

std::size_t quantize_boxes(const Grid& grid, std::span<const Aabb> boxes, std::uint32_t slot,
                           QuantizedBox* out) {
  return HWY_DYNAMIC_DISPATCH(quantize)(grid, boxes, slot, out);
}

std::uint64_t search_cells(const Grid& grid, const BinnedBoxes& boxes, std::size_t level, std::size_t begin,
                           std::size_t end, PairList& pairs) {
  return HWY_DYNAMIC_DISPATCH(search)(grid, boxes, level, begin, end, pairs);
}

}  // namespace supple
#endif
