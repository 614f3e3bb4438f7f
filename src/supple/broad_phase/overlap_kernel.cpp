#include "broad_phase/overlap_kernel.hpp"

#include <algorithm>
#include <array>
#include <limits>

// Highway compiles the rest of this file once for each instruction set, and picks one when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "broad_phase/overlap_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, max_lanes>;
using Integers = hn::RebindToUnsigned<Floats>;

/// Adds the pairs of a row and those of the boxes at `column` whose lanes are hit and that begin here to the
/// batch. Returns how many pairs the batch has then.
template <class Mask>
HWY_INLINE std::size_t append(const BoxLanes& boxes, std::size_t row, std::size_t column, Mask hit,
                              std::size_t count, PairBins& pairs) {
  const Integers lanes;
  const auto begins =
      hn::Or(hn::Set(lanes, boxes.begins[row]), hn::LoadU(lanes, boxes.begins.data() + column));
  const auto reported = hn::And(hn::RebindMask(lanes, hit), hn::Eq(begins, hn::Set(lanes, 7)));
  hn::StoreU(hn::Set(lanes, boxes.slots[row]), lanes, pairs.first.data() + count);
  hn::StoreU(packed_lanes(lanes, hn::LoadU(lanes, boxes.slots.data() + column), reported), lanes,
             pairs.second.data() + count);
  return count + hn::CountTrue(lanes, reported);
}

template <bool sorted>
HWY_INLINE std::uint64_t find_rows(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                                   std::span<const BoundingSphere> spheres, PairBins& pairs) {
  const Floats lanes;
  const float* const min_x = boxes.min[0].data();
  const float* const min_y = boxes.min[1].data();
  const float* const min_z = boxes.min[2].data();
  const float* const max_x = boxes.max[0].data();
  const float* const max_y = boxes.max[1].data();
  const float* const max_z = boxes.max[2].data();
  std::uint64_t tests = 0;
  std::size_t count = 0;
  for (std::size_t row = begin; row < end; ++row) {
    const auto row_min_x = hn::Set(lanes, min_x[row]), row_max_x = hn::Set(lanes, max_x[row]);
    const auto row_min_y = hn::Set(lanes, min_y[row]), row_max_y = hn::Set(lanes, max_y[row]);
    const auto row_min_z = hn::Set(lanes, min_z[row]), row_max_z = hn::Set(lanes, max_z[row]);
    for (std::size_t j = row + 1; j < boxes.count; j += hn::Lanes(lanes)) {
      const auto begin_before = hn::Le(hn::LoadU(lanes, min_x + j), row_max_x);
      auto hit = hn::And(begin_before, hn::And(hn::Le(hn::LoadU(lanes, min_y + j), row_max_y),
                                               hn::Ge(hn::LoadU(lanes, max_y + j), row_min_y)));
      hit = hn::And(hit, hn::And(hn::Le(hn::LoadU(lanes, min_z + j), row_max_z),
                                 hn::Ge(hn::LoadU(lanes, max_z + j), row_min_z)));
      if constexpr (!sorted) hit = hn::And(hit, hn::Ge(hn::LoadU(lanes, max_x + j), row_min_x));
      if (!hn::AllFalse(lanes, hit)) count = append(boxes, row, j, hit, count, pairs);
      if (HWY_UNLIKELY(count > PairBins::batch_size)) {
        pairs.flush(count, spheres);
        count = 0;
      }
      if constexpr (sorted) {
        tests += hn::CountTrue(lanes, begin_before);
        if (!hn::AllTrue(lanes, begin_before)) break;
      }
    }
    if constexpr (!sorted) tests += boxes.count - row - 1;
  }
  pairs.flush(count, spheres);
  return tests;
}

std::uint64_t find_all(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                       std::span<const BoundingSphere> spheres, PairBins& pairs) {
  return find_rows<false>(boxes, begin, end, spheres, pairs);
}

std::uint64_t find_sorted(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                          std::span<const BoundingSphere> spheres, PairBins& pairs) {
  return find_rows<true>(boxes, begin, end, spheres, pairs);
}

/// A box is loaded as its first four and its last four numbers; a bound that always holds stands where they
/// say the same or belong to the other end.
std::size_t find_of(const Aabb& box, std::span<const Aabb> boxes, std::span<const std::uint32_t> slots,
                    std::uint32_t* found) {
  const hn::CappedTag<float, 4> lanes;  // four, but for the target without vectors
  constexpr float infinity = std::numeric_limits<float>::infinity();
  alignas(16) const std::array<float, 4> upper{box.max.x, box.max.y, box.max.z, infinity};
  alignas(16) const std::array<float, 4> lower{-infinity, box.min.x, box.min.y, box.min.z};
  // The boxes are apart in memory: prefetch all before the first is needed.
  for (const std::uint32_t slot : slots) hwy::Prefetch(&boxes[slot]);
  std::size_t count = 0;
  for (const std::uint32_t slot : slots) {
    const float* const ends = &boxes[slot].min.x;
    bool overlaps = true;
    for (std::size_t i = 0; i < 4; i += hn::Lanes(lanes)) {
      const auto starts = hn::Le(hn::LoadU(lanes, ends + i), hn::Load(lanes, upper.data() + i));
      const auto stops = hn::Ge(hn::LoadU(lanes, ends + 2 + i), hn::Load(lanes, lower.data() + i));
      overlaps = overlaps && hn::AllTrue(lanes, hn::And(starts, stops));
    }
    // No branch: which of them overlap is unpredictable.
    found[count] = slot;
    count += static_cast<std::size_t>(overlaps);
  }
  return count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(find_all);
HWY_EXPORT(find_sorted);
HWY_EXPORT(find_of);

void BoxLanes::resize(std::size_t new_count) {
  count = new_count;
  if (slots.size() < count + max_lanes) {
    const std::size_t size = count + count / 2 + max_lanes;
    for (std::vector<float>& ends : min) ends.resize(size);
    for (std::vector<float>& ends : max) ends.resize(size);
    slots.resize(size);
    begins.resize(size);
  }
  std::fill_n(min[0].begin() + static_cast<std::ptrdiff_t>(count), max_lanes,
              std::numeric_limits<float>::quiet_NaN());
}

std::uint64_t find_overlaps(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                            std::span<const BoundingSphere> spheres, PairBins& pairs) {
  return HWY_DYNAMIC_DISPATCH(find_all)(boxes, begin, end, spheres, pairs);
}

std::uint64_t find_overlaps_sorted(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                                   std::span<const BoundingSphere> spheres, PairBins& pairs) {
  return HWY_DYNAMIC_DISPATCH(find_sorted)(boxes, begin, end, spheres, pairs);
}

void find_overlaps_of(const Aabb& box, std::span<const Aabb> boxes, std::span<const std::uint32_t> slots,
                      std::vector<std::uint32_t>& found) {
  static_assert(sizeof(Aabb) == 6 * sizeof(float));
  found.resize(slots.size() + 1);
  found.resize(HWY_DYNAMIC_DISPATCH(find_of)(box, boxes, slots, found.data()));
}

}  // namespace supple
#endif
