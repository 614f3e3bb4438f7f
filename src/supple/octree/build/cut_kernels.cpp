#include "octree/build/cut_kernels.hpp"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/build/cut_kernels.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint32_t, 16>;
using Floats = hn::RebindToFloat<Words>;
using Cells = hn::Rebind<std::uint16_t, Words>;

PointBox BoxOfPoints(const PointArrays& points, std::size_t count) {
  const Floats floats;
  const std::size_t lanes = hn::Lanes(floats);
  auto low_x = hn::Set(floats, std::numeric_limits<float>::infinity()), low_y = low_x, low_z = low_x;
  auto high_x = hn::Neg(low_x), high_y = high_x, high_z = high_x;
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto x = hn::LoadU(floats, points.at[0] + i);
    const auto y = hn::LoadU(floats, points.at[1] + i);
    const auto z = hn::LoadU(floats, points.at[2] + i);
    low_x = hn::Min(low_x, x), high_x = hn::Max(high_x, x);
    low_y = hn::Min(low_y, y), high_y = hn::Max(high_y, y);
    low_z = hn::Min(low_z, z), high_z = hn::Max(high_z, z);
  }
  const auto least = [&](auto low) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(floats, low)); };
  const auto greatest = [&](auto high) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(floats, high)); };
  PointBox box{{least(low_x), least(low_y), least(low_z)},
               {greatest(high_x), greatest(high_y), greatest(high_z)}};
  for (; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], points.at[axis][i]);
      box.high[axis] = std::max(box.high[axis], points.at[axis][i]);
    }
  }
  return box;
}

void NumberCells(const float* coordinates, std::size_t count, float low, float scale, std::uint32_t cells,
                 std::uint16_t* cell_of_point) {
  const Floats floats;
  const Cells narrow;
  const hn::RebindToSigned<Words> integers;
  const auto last = hn::Set(integers, static_cast<std::int32_t>(cells - 1));
  const std::size_t lanes = hn::Lanes(floats);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto offset = hn::Sub(hn::LoadU(floats, coordinates + i), hn::Set(floats, low));
    const auto cell = hn::ConvertTo(integers, hn::Mul(offset, hn::Set(floats, scale)));
    hn::StoreU(hn::DemoteTo(narrow, hn::Min(cell, last)), narrow, cell_of_point + i);
  }
  for (; i < count; ++i) {
    const auto cell = static_cast<std::uint32_t>((coordinates[i] - low) * scale);
    cell_of_point[i] = static_cast<std::uint16_t>(std::min(cell, cells - 1));
  }
}

/// Appends the chosen lanes of `values` to `end`. Writes a whole vector.
template <class Values, class Scalar>
HWY_INLINE void append(hn::Vec<Values> values, hn::Mask<Words> chosen, Scalar* end) {
  const auto packed = packed_lanes(Words(), hn::BitCast(Words(), values), chosen);
  hn::StoreU(hn::BitCast(Values(), packed), Values(), end);
}

/// Puts points from `from` on where `lower` and `upper` end. The lanes behind the lower ones overwrite only
/// points that have been read.
template <class Values, class Scalar>
HWY_INLINE void divide(Scalar* points, std::size_t from, std::size_t lower, Scalar* upper,
                       hn::Mask<Words> goes_down) {
  const auto values = hn::LoadU(Values(), points + from);
  append<Values>(values, goes_down, points + lower);
  append<Values>(values, hn::Not(goes_down), upper + (from - lower));
}

std::uint32_t PartitionPoints(const PointArrays& points, std::size_t count,
                              const std::uint16_t* cell_of_point, std::uint32_t border,
                              const PointArrays& upper) {
  const Words words;
  const std::size_t lanes = hn::Lanes(words);
  std::size_t lower = 0, i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto cells = hn::PromoteTo(words, hn::LoadU(Cells(), cell_of_point + i));
    const auto goes_down = hn::Lt(cells, hn::Set(words, border));
    divide<Floats>(points.at[0], i, lower, upper.at[0], goes_down);
    divide<Floats>(points.at[1], i, lower, upper.at[1], goes_down);
    divide<Floats>(points.at[2], i, lower, upper.at[2], goes_down);
    divide<Words>(points.triangles, i, lower, upper.triangles, goes_down);
    lower += hn::CountTrue(words, goes_down);
  }
  for (; i < count; ++i) {
    const bool goes_down = cell_of_point[i] < border;
    const std::size_t up = i - lower;
    for (std::size_t axis = 0; axis < 3; ++axis)
      points.at[axis][lower] = upper.at[axis][up] = points.at[axis][i];
    points.triangles[lower] = upper.triangles[up] = points.triangles[i];
    lower += goes_down ? 1 : 0;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    std::copy_n(upper.at[axis], count - lower, points.at[axis] + lower);
  std::copy_n(upper.triangles, count - lower, points.triangles + lower);
  return static_cast<std::uint32_t>(lower);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(BoxOfPoints);
HWY_EXPORT(NumberCells);
HWY_EXPORT(PartitionPoints);

PointBox box_of_points(const PointArrays& points, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(BoxOfPoints)(points, count);
}

void number_cells(const float* coordinates, std::size_t count, float low, float scale, std::uint32_t cells,
                  std::uint16_t* cell_of_point) {
  HWY_DYNAMIC_DISPATCH(NumberCells)(coordinates, count, low, scale, cells, cell_of_point);
}

std::uint32_t partition_points(const PointArrays& points, std::size_t count,
                               const std::uint16_t* cell_of_point, std::uint32_t border,
                               const PointArrays& upper) {
  return HWY_DYNAMIC_DISPATCH(PartitionPoints)(points, count, cell_of_point, border, upper);
}

}  // namespace supple
#endif
