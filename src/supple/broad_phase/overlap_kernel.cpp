#include "broad_phase/overlap_kernel.hpp"

#include <algorithm>
#include <limits>

// Highway compiles the rest of this file once for each instruction set, and picks one when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "broad_phase/overlap_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, max_lanes>;
using Integers = hn::RebindToUnsigned<Floats>;

/// Adds the pairs of box `row` with the boxes of hit lanes, counted from `column`, that begin here and have
/// paired kinds. Returns the new number of pairs in the batch.
template <bool has_kinds, class Mask>
HWY_INLINE std::size_t append(const BoxLanes& boxes, std::size_t row, std::size_t column, Mask hit,
                              std::size_t count, PairList& pairs) {
  const Integers lanes;
  const std::uint32_t row_marks = boxes.marks[row];
  const auto required =
      hn::Set(lanes, has_kinds ? PairMarks::required(row_marks) : std::uint32_t{PairMarks::begins});
  auto marks = hn::Or(hn::Set(lanes, has_kinds ? row_marks & PairMarks::begins : row_marks),
                      hn::LoadU(lanes, boxes.marks.data() + column));
  if (has_kinds) marks = hn::And(marks, required);
  const auto reported = hn::And(hn::RebindMask(lanes, hit), hn::Eq(marks, required));
  hn::StoreU(hn::Set(lanes, boxes.slots[row]), lanes, pairs.first.data() + count);
  hn::StoreU(packed_lanes(lanes, hn::LoadU(lanes, boxes.slots.data() + column), reported), lanes,
             pairs.second.data() + count);
  return count + hn::CountTrue(lanes, reported);
}

template <bool has_kinds>
std::uint64_t find_pairs(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                         std::span<const BoundingSphere> spheres, PairList& pairs) {
  const Floats lanes;
  const float* const min_x = boxes.min[0].data();
  const float* const min_y = boxes.min[1].data();
  const float* const min_z = boxes.min[2].data();
  const float* const max_x = boxes.max[0].data();
  const float* const max_y = boxes.max[1].data();
  const float* const max_z = boxes.max[2].data();
  const bool is_sorted = boxes.is_sorted;
  std::uint64_t tests = 0;
  std::size_t count = 0;
  for (std::size_t row = begin; row < end; ++row) {
    const auto row_min_x = hn::Set(lanes, min_x[row]), row_max_x = hn::Set(lanes, max_x[row]);
    const auto row_min_y = hn::Set(lanes, min_y[row]), row_max_y = hn::Set(lanes, max_y[row]);
    const auto row_min_z = hn::Set(lanes, min_z[row]), row_max_z = hn::Set(lanes, max_z[row]);
    for (std::size_t j = row + 1; j < boxes.count; j += hn::Lanes(lanes)) {
      const auto begin_before = hn::Le(hn::LoadU(lanes, min_x + j), row_max_x);
      const auto in_x = hn::And(begin_before, hn::Ge(hn::LoadU(lanes, max_x + j), row_min_x));
      const auto in_y = hn::And(hn::Le(hn::LoadU(lanes, min_y + j), row_max_y),
                                hn::Ge(hn::LoadU(lanes, max_y + j), row_min_y));
      const auto in_z = hn::And(hn::Le(hn::LoadU(lanes, min_z + j), row_max_z),
                                hn::Ge(hn::LoadU(lanes, max_z + j), row_min_z));
      const auto hit = hn::And(in_x, hn::And(in_y, in_z));
      if (!hn::AllFalse(lanes, hit)) count = append<has_kinds>(boxes, row, j, hit, count, pairs);
      if (HWY_UNLIKELY(count > PairList::batch_size)) {
        pairs.flush(count, spheres);
        count = 0;
      }
      if (!is_sorted) continue;
      tests += hn::CountTrue(lanes, begin_before);
      if (!hn::AllTrue(lanes, begin_before)) break;
    }
    if (!is_sorted) tests += boxes.count - row - 1;
  }
  pairs.flush(count, spheres);
  return tests;
}

std::uint64_t find(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                   std::span<const BoundingSphere> spheres, bool has_kinds, PairList& pairs) {
  return has_kinds ? find_pairs<true>(boxes, begin, end, spheres, pairs)
                   : find_pairs<false>(boxes, begin, end, spheres, pairs);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(find);

void BoxLanes::resize(std::size_t new_count) {
  count = new_count;
  if (slots.size() < count + max_lanes) {
    const std::size_t size = count + count / 2 + max_lanes;
    for (std::vector<float>& ends : min) ends.resize(size);
    for (std::vector<float>& ends : max) ends.resize(size);
    slots.resize(size);
    marks.resize(size);
  }
  std::fill_n(min[0].begin() + static_cast<std::ptrdiff_t>(count), max_lanes,
              std::numeric_limits<float>::quiet_NaN());
}

std::uint64_t find_overlaps(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                            const VolumeStore& volumes, PairList& pairs) {
  return HWY_DYNAMIC_DISPATCH(find)(boxes, begin, end, volumes.spheres(), volumes.wanted().has_kinds(),
                                    pairs);
}

}  // namespace supple
#endif
