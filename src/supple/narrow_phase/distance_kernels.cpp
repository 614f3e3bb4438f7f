#include "narrow_phase/distance_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "narrow_phase/distance_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Of the boxes from `first` on, a vector of them.
template <class Tag, class Boxes>
HWY_INLINE hn::Vec<Tag> squares_of(Tag d, const PointBounds& point, const Boxes& boxes, std::size_t first) {
  const auto gap = [&](const float* low, const float* high, float point_low, float point_high) HWY_ATTR {
    const auto below = hn::Sub(hn::Load(d, low + first), hn::Set(d, point_high));
    const auto above = hn::Sub(hn::Set(d, point_low), hn::Load(d, high + first));
    return hn::Max(hn::Max(below, above), hn::Zero(d));
  };
  const auto x = gap(boxes.min_x, boxes.max_x, point.low.x, point.high.x);
  const auto y = gap(boxes.min_y, boxes.max_y, point.low.y, point.high.y);
  const auto z = gap(boxes.min_z, boxes.max_z, point.low.z, point.high.z);
  return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}

void SquaredDistances(const PointBounds& point, const ChildBoxes& boxes, float* squares) {
  const hn::CappedTag<float, node_width> d;
  for (std::size_t i = 0; i < node_width; i += hn::Lanes(d))
    hn::StoreU(squares_of(d, point, boxes, i), d, squares + i);
}

std::uint64_t NearTriangles(const PointBounds& point, const LeafBoxes& boxes, float limit) {
  const hn::CappedTag<float, 16> d;
  std::uint64_t near = 0;
  for (std::size_t i = 0; i < boxes.size; i += hn::Lanes(d))
    near |= mask_bits(d, hn::Le(squares_of(d, point, boxes, i), hn::Set(d, limit))) << i;
  return near & boxes.triangles;
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(SquaredDistances);
HWY_EXPORT(NearTriangles);

void squared_distances(const PointBounds& point, const ChildBoxes& boxes, float* squares) {
  HWY_DYNAMIC_DISPATCH(SquaredDistances)(point, boxes, squares);
}
std::uint64_t near_triangles(const PointBounds& point, const LeafBoxes& boxes, float limit) {
  return HWY_DYNAMIC_DISPATCH(NearTriangles)(point, boxes, limit);
}

}  // namespace supple
#endif
