#include "narrow_phase/query_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "narrow_phase/query_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <limits>

#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Squared distances of the boxes from `first` on, a vector of them.
template <class Tag, class Boxes>
HWY_INLINE hn::Vec<Tag> squares_of(Tag d, const Aabb& point, const Boxes& boxes, std::size_t first) {
  const auto gap = [&](const float* low, const float* high, float point_low, float point_high) HWY_ATTR {
    const auto below = hn::Sub(hn::Load(d, low + first), hn::Set(d, point_high));
    const auto above = hn::Sub(hn::Set(d, point_low), hn::Load(d, high + first));
    return hn::Max(hn::Max(below, above), hn::Zero(d));
  };
  const auto x = gap(boxes.min_x, boxes.max_x, point.min.x, point.max.x);
  const auto y = gap(boxes.min_y, boxes.max_y, point.min.y, point.max.y);
  const auto z = gap(boxes.min_z, boxes.max_z, point.min.z, point.max.z);
  return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}

void SquaredDistances(const Aabb& point, const ChildBoxes& boxes, float* squares) {
  const hn::CappedTag<float, node_width> d;
  for (std::size_t i = 0; i < node_width; i += hn::Lanes(d))
    hn::StoreU(squares_of(d, point, boxes, i), d, squares + i);
}

std::uint64_t NearTriangles(const Aabb& point, const LeafBoxes& boxes, float limit) {
  const hn::CappedTag<float, 16> d;
  std::uint64_t near = 0;
  for (std::size_t i = 0; i < boxes.size; i += hn::Lanes(d))
    near |= mask_bits(d, hn::Le(squares_of(d, point, boxes, i), hn::Set(d, limit))) << i;
  return near & boxes.triangles;
}

void PacketDistances(const PointPacket& points, const ChildBoxes& boxes, float* squares) {
  const hn::CappedTag<float, node_width> d;
  for (std::size_t i = 0; i < node_width; i += hn::Lanes(d)) {
    auto least = hn::Inf(d);
    for (std::size_t k = 0; k < PointPacket::capacity; ++k) {
      const Vec3f p{points.points[0][k], points.points[1][k], points.points[2][k]};
      const auto square = squares_of(d, {p, p}, boxes, i);
      const auto near = hn::IfThenElse(hn::Le(square, hn::Set(d, points.limits[k])), square, hn::Inf(d));
      least = hn::Min(least, near);
    }
    hn::StoreU(least, d, squares + i);
  }
}

/// Which points are so near to the cylinder of a leaf.
std::uint64_t PointsNearLeaf(const PointPacket& points, const LeafCorners& leaf) {
  const hn::CappedTag<float, PointPacket::capacity> d;
  const auto zero = hn::Zero(d), less = hn::Set(d, 1 - 0x1p-17F);
  std::uint64_t near = 0;
  for (std::size_t k = 0; k < PointPacket::capacity; k += hn::Lanes(d)) {
    const auto x = hn::Sub(hn::Load(d, points.points[0] + k), hn::Set(d, leaf.middle.x)),
               y = hn::Sub(hn::Load(d, points.points[1] + k), hn::Set(d, leaf.middle.y)),
               z = hn::Sub(hn::Load(d, points.points[2] + k), hn::Set(d, leaf.middle.z));
    const auto square = hn::MulAdd(z, z, hn::MulAdd(y, y, hn::Mul(x, x)));
    const auto along =
        hn::Abs(hn::MulAdd(z, hn::Set(d, leaf.axis.z),
                           hn::MulAdd(y, hn::Set(d, leaf.axis.y), hn::Mul(x, hn::Set(d, leaf.axis.x)))));
    const auto across = hn::Sqrt(hn::Max(hn::NegMulAdd(along, along, hn::Mul(square, less)), zero));
    // The rounding of `along` is in proportion to the distance of the middle.
    const auto above = hn::Max(
        hn::NegMulAdd(hn::Sqrt(square), hn::Set(d, 0x1p-20F), hn::Sub(along, hn::Set(d, leaf.height))), zero);
    const auto beside = hn::Max(hn::Sub(across, hn::Set(d, leaf.radius)), zero);
    const auto least = hn::Mul(hn::MulAdd(above, above, hn::Mul(beside, beside)), less);
    near |= mask_bits(d, hn::Le(least, hn::Load(d, points.limits + k))) << k;
  }
  return near;
}

std::uint64_t NearInPacket(PointPacket& points, const LeafCorners& leaf, PacketBounds& squares) {
  if (PointsNearLeaf(points, leaf) == 0) return 0;
  const hn::CappedTag<float, PointPacket::capacity> d;
  std::uint64_t near = 0;
  for (std::size_t k = 0; k < PointPacket::capacity; k += hn::Lanes(d)) {
    const auto px = hn::Load(d, points.points[0] + k), py = hn::Load(d, points.points[1] + k),
               pz = hn::Load(d, points.points[2] + k);
    auto least = hn::Inf(d);
    for (std::size_t i = 0; i < leaf.size; ++i) {
      const auto square = [&](std::size_t corner) HWY_ATTR {
        const auto x = hn::Sub(px, hn::Set(d, leaf.corners[corner][0][i])),
                   y = hn::Sub(py, hn::Set(d, leaf.corners[corner][1][i])),
                   z = hn::Sub(pz, hn::Set(d, leaf.corners[corner][2][i]));
        return hn::MulAdd(z, z, hn::MulAdd(y, y, hn::Mul(x, x)));
      };
      const auto nearest = hn::Min(hn::Min(square(0), square(1)), square(2));
      least = hn::Min(least, nearest);
      const auto without_spread = hn::Sub(nearest, hn::Set(d, leaf.spread[i]));
      hn::StoreU(hn::NegMulAdd(nearest, hn::Set(d, 0x1p-18F), without_spread), d, squares[i].data() + k);
    }
    const auto more = hn::Set(d, 1 + 0x1p-18F);
    const auto reach = hn::MulAdd(hn::Sqrt(least), more, hn::Set(d, 2 * points.slack));
    const auto limit = hn::Min(hn::Load(d, points.limits + k), hn::Mul(hn::Mul(reach, reach), more));
    hn::Store(limit, d, points.limits + k);
    for (std::size_t i = 0; i < leaf.size; ++i) {
      const bool is_near = !hn::AllFalse(d, hn::Le(hn::LoadU(d, squares[i].data() + k), limit));
      near |= std::uint64_t{is_near} << i;
    }
  }
  return near;
}

/// Lower bounds for the boxes from `first` on.
template <class Tag, class Boxes>
HWY_INLINE hn::Vec<Tag> bounds_of(Tag d, const RaySlabs& ray, const Boxes& boxes, std::size_t first) {
  const hn::Rebind<float, Tag> singles;
  const auto infinity = hn::Inf(d), largest = hn::Set(d, std::numeric_limits<double>::max());
  auto enter = hn::Zero(d), leave = infinity;
  auto meets = hn::Eq(enter, enter);
  const float* const mins[] = {boxes.min_x, boxes.min_y, boxes.min_z};
  const float* const maxs[] = {boxes.max_x, boxes.max_y, boxes.max_z};
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.is_unlimited[static_cast<std::size_t>(axis)]) continue;
    const auto low = hn::PromoteTo(d, hn::Load(singles, mins[axis] + first)),
               high = hn::PromoteTo(d, hn::Load(singles, maxs[axis] + first));
    const auto origin_low = hn::Set(d, ray.low[axis]), origin_high = hn::Set(d, ray.high[axis]);
    if (ray.is_parallel[static_cast<std::size_t>(axis)]) {
      meets = hn::And(meets, hn::And(hn::Le(low, origin_high), hn::Ge(high, origin_low)));
      continue;
    }
    const auto reciprocal = hn::Set(d, ray.reciprocal[axis]);
    const auto to_low = hn::Mul(hn::Sub(low, origin_high), reciprocal),
               to_high = hn::Mul(hn::Sub(high, origin_low), reciprocal);
    // Widened by more than the roundings of a difference, a reciprocal and a product. Products that overflow
    // stay finite, because the difference of two infinities would exclude the box.
    const auto near = hn::Min(ray.reciprocal[axis] > 0 ? to_low : to_high, largest),
               far = hn::Max(ray.reciprocal[axis] > 0 ? to_high : to_low, hn::Neg(largest));
    const auto slack = [&](hn::Vec<Tag> t) HWY_ATTR {
      return hn::Add(hn::Mul(hn::Abs(t), hn::Set(d, 0x1p-49)), hn::Set(d, 0x1p-1060));
    };
    enter = hn::Max(enter, hn::Sub(near, slack(near)));
    leave = hn::Min(leave, hn::Add(far, slack(far)));
  }
  return hn::IfThenElse(hn::And(meets, hn::Le(enter, leave)), hn::Min(enter, largest), infinity);
}

void RayBounds(const RaySlabs& ray, const ChildBoxes& boxes, double* bounds) {
  const hn::CappedTag<double, node_width> d;
  for (std::size_t i = 0; i < node_width; i += hn::Lanes(d))
    hn::StoreU(bounds_of(d, ray, boxes, i), d, bounds + i);
}

std::uint64_t TrianglesOnRay(const RaySlabs& ray, const LeafBoxes& boxes, double limit) {
  const hn::CappedTag<double, 8> d;
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < boxes.size; i += hn::Lanes(d))
    found |= mask_bits(d, hn::Le(bounds_of(d, ray, boxes, i), hn::Set(d, limit))) << i;
  return found & boxes.triangles;
}

void FindCells(const CellGrid& grid, std::span<const Vec3d> points, std::uint32_t* cells) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<std::int32_t, decltype(d)> integers;
  const hn::Rebind<std::uint32_t, decltype(d)> words;
  for (std::size_t i = 0; i < points.size(); i += hn::Lanes(d)) {
    std::array<Vec3d, 8> last{};
    const bool is_last = points.size() - i < hn::Lanes(d);
    if (is_last) std::copy(points.begin() + static_cast<std::ptrdiff_t>(i), points.end(), last.begin());
    hn::Vec<decltype(d)> along[3];
    hn::LoadInterleaved3(d, is_last ? &last[0].x : &points[i].x, along[0], along[1], along[2]);
    auto is_in = hn::Eq(hn::Zero(d), hn::Zero(d));
    auto cell = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis) {
      const auto low = hn::Set(d, grid.low[axis]), high = hn::Set(d, grid.high[axis]);
      is_in = hn::And(is_in, hn::And(hn::Ge(along[axis], low), hn::Le(along[axis], high)));
      const auto place = hn::Min(hn::Mul(hn::Sub(along[axis], low), hn::Set(d, grid.scale[axis])),
                                 hn::Set(d, grid.counts[static_cast<std::size_t>(axis)] - 1.0));
      const auto step = hn::Set(d, 1.0 * grid.step(axis));
      cell = hn::Add(cell, hn::Mul(hn::Add(hn::Trunc(place), hn::Set(d, 1.0)), step));
    }
    const auto found = hn::DemoteTo(integers, hn::IfThenElseZero(is_in, cell));
    hn::StoreU(hn::BitCast(words, found), words, cells + i);
  }
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(SquaredDistances);
HWY_EXPORT(NearTriangles);
HWY_EXPORT(PacketDistances);
HWY_EXPORT(NearInPacket);
HWY_EXPORT(RayBounds);
HWY_EXPORT(TrianglesOnRay);
HWY_EXPORT(FindCells);

void squared_distances(const Aabb& point, const ChildBoxes& boxes, std::array<float, 8>& squares) {
  HWY_DYNAMIC_DISPATCH(SquaredDistances)(point, boxes, squares.data());
}
std::uint64_t near_triangles(const Aabb& point, const LeafBoxes& boxes, float limit) {
  return HWY_DYNAMIC_DISPATCH(NearTriangles)(point, boxes, limit);
}
void squared_distances(const PointPacket& points, const ChildBoxes& boxes, std::array<float, 8>& squares) {
  HWY_DYNAMIC_DISPATCH(PacketDistances)(points, boxes, squares.data());
}
std::uint64_t near_triangles(PointPacket& points, const LeafCorners& leaf, PacketBounds& squares) {
  return HWY_DYNAMIC_DISPATCH(NearInPacket)(points, leaf, squares);
}
void ray_bounds(const RaySlabs& ray, const ChildBoxes& boxes, std::array<double, 8>& bounds) {
  HWY_DYNAMIC_DISPATCH(RayBounds)(ray, boxes, bounds.data());
}
std::uint64_t triangles_on_ray(const RaySlabs& ray, const LeafBoxes& boxes, double limit) {
  return HWY_DYNAMIC_DISPATCH(TrianglesOnRay)(ray, boxes, limit);
}
void find_cells(const CellGrid& grid, std::span<const Vec3d> points,
                std::array<std::uint32_t, CellGrid::block>& cells) {
  HWY_DYNAMIC_DISPATCH(FindCells)(grid, points, cells.data());
}

}  // namespace supple
#endif
