#include "contact/intersection/triangle_bounds.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/intersection/triangle_bounds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "geometry/vector3-inl.hpp"
#include "mesh/corner_loads-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// About the point of each triangle that is closest to the origin. For a triangle almost without area it may
/// be any point; `is_in_triangle` says whether it is in the triangle.
///
/// Ericson, Real-Time Collision Detection, 2005, section 5.1.5, from the last case to the first.
template <class Tag>
HWY_INLINE Vector3<Tag> rough_closest(const Corners<Tag>& c, hn::Mask<Tag>& is_in_triangle) {
  const Tag d;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1);
  const auto u = subtract<Tag>(c[1], c[0]), v = subtract<Tag>(c[2], c[0]);
  const auto u0 = hn::Neg(dot<Tag>(u, c[0])), v0 = hn::Neg(dot<Tag>(v, c[0])),
             u1 = hn::Neg(dot<Tag>(u, c[1])), v1 = hn::Neg(dot<Tag>(v, c[1])),
             u2 = hn::Neg(dot<Tag>(u, c[2])), v2 = hn::Neg(dot<Tag>(v, c[2]));
  const auto on_w = hn::Sub(hn::Mul(u0, v1), hn::Mul(u1, v0)),
             on_v = hn::Sub(hn::Mul(u2, v0), hn::Mul(u0, v2)),
             on_u = hn::Sub(hn::Mul(u1, v2), hn::Mul(u2, v1));
  // The point is c0 + (s u + t v) / whole. First: inside the triangle.
  auto s = on_v, t = on_w, whole = hn::Add(hn::Add(on_u, on_v), on_w);
  const auto choose = [&](hn::Mask<Tag> where, hn::Vec<Tag> new_s, hn::Vec<Tag> new_t, hn::Vec<Tag> new_whole)
                          HWY_ATTR {
                            s = hn::IfThenElse(where, new_s, s);
                            t = hn::IfThenElse(where, new_t, t);
                            whole = hn::IfThenElse(where, new_whole, whole);
                          };
  const auto along = hn::Sub(v1, u1), back = hn::Sub(u2, v2);
  choose(hn::And(hn::Le(on_u, zero), hn::And(hn::Ge(along, zero), hn::Ge(back, zero))), back, along,
         hn::Add(along, back));
  choose(hn::And(hn::Le(on_v, zero), hn::And(hn::Ge(v0, zero), hn::Le(v2, zero))), zero, v0, hn::Sub(v0, v2));
  choose(hn::And(hn::Ge(v2, zero), hn::Le(u2, v2)), zero, one, one);
  choose(hn::And(hn::Le(on_w, zero), hn::And(hn::Ge(u0, zero), hn::Le(u1, zero))), u0, zero, hn::Sub(u0, u1));
  choose(hn::And(hn::Ge(u1, zero), hn::Le(v1, u1)), one, zero, one);
  choose(hn::And(hn::Le(u0, zero), hn::Le(v0, zero)), zero, zero, one);
  const auto part = hn::Div(one, whole);
  s = hn::Mul(s, part);
  t = hn::Mul(t, part);
  is_in_triangle =
      hn::And(hn::And(hn::Ge(s, zero), hn::Ge(t, zero)), hn::Le(hn::Add(s, t), hn::Set(d, 1 + 0x1p-50)));
  const auto sum = [&](hn::Vec<Tag> c0, hn::Vec<Tag> along_u, hn::Vec<Tag> along_v)
                       HWY_ATTR { return hn::Add(c0, hn::Add(hn::Mul(s, along_u), hn::Mul(t, along_v))); };
  return {sum(c[0].x, u.x, v.x), sum(c[0].y, u.y, v.y), sum(c[0].z, u.z, v.z)};
}

void BoundDistances(const Vec3d* points, const PlacedTriangles& triangles, const TrianglePair* list,
                    std::size_t count, double* lower, double* upper) {
  using Tag = hn::CappedTag<double, 8>;
  const Tag d;
  for_each_vector(d, list, count, [&](std::size_t first, const TrianglePair* part) HWY_ATTR {
    Corners<Tag> corners;
    read_corners<&TrianglePair::a, Tag>(triangles, part, corners);
    HWY_ALIGN double coordinates[3][hn::MaxLanes(Tag())];
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      for (int axis = 0; axis < 3; ++axis) coordinates[axis][i] = points[part[i].b][axis];
    }
    const Vector3<Tag> p{hn::Load(d, coordinates[0]), hn::Load(d, coordinates[1]),
                         hn::Load(d, coordinates[2])};
    for (auto& corner : corners) corner = subtract<Tag>(corner, p);
    hn::Mask<Tag> is_in_triangle;
    const Vector3<Tag> normal = rough_closest<Tag>(corners, is_in_triangle);
    const auto square = dot<Tag>(normal, normal);
    const auto farthest =
        hn::Max(dot<Tag>(corners[0], corners[0]),
                hn::Max(dot<Tag>(corners[1], corners[1]), dot<Tag>(corners[2], corners[2])));
    const auto least = hn::Min(dot<Tag>(corners[0], normal),
                               hn::Min(dot<Tag>(corners[1], normal), dot<Tag>(corners[2], normal)));
    // A product of vectors has a rounding error below 2^-50 of the product of their lengths; the point has
    // one below 2^-50 of the largest length.
    const auto length = hn::Sqrt(square), slack = hn::Mul(hn::Set(d, 0x1p-48), hn::Sqrt(farthest));
    const auto distance = hn::Sub(hn::Div(least, length), slack);
    const auto is_certain =
        hn::And(hn::Gt(square, hn::Set(d, 0x1p-900)), hn::Lt(farthest, hn::Set(d, 0x1p900)));
    hn::StoreU(hn::IfThenElseZero(hn::And(is_certain, hn::Gt(distance, hn::Zero(d))), distance), d,
               lower + first);
    hn::StoreU(hn::IfThenElse(hn::And(is_certain, is_in_triangle),
                              hn::Add(hn::Mul(length, hn::Set(d, 1 + 0x1p-48)), slack), hn::Inf(d)),
               d, upper + first);
  });
}

void BoundDepths(const Vec3d& origin, const Vec3d& normal, const PlacedTriangles& triangles,
                 const TrianglePair* list, std::size_t count, double* least) {
  using Tag = hn::CappedTag<double, 8>;
  const Tag d;
  const Vector3<Tag> o{hn::Set(d, origin.x), hn::Set(d, origin.y), hn::Set(d, origin.z)},
      n{hn::Set(d, normal.x), hn::Set(d, normal.y), hn::Set(d, normal.z)};
  for_each_vector(d, list, count, [&](std::size_t first, const TrianglePair* part) HWY_ATTR {
    Corners<Tag> corners;
    read_corners<&TrianglePair::a, Tag>(triangles, part, corners);
    auto depth = hn::Inf(d);
    for (const auto& corner : corners) {
      const auto way = subtract<Tag>(corner, o);
      // More than the roundings of the difference, the vector and the sum.
      const auto slack = hn::Add(
          hn::Mul(hn::Add(hn::Add(hn::Abs(way.x), hn::Abs(way.y)), hn::Abs(way.z)), hn::Set(d, 0x1p-48)),
          hn::Set(d, 0x1p-1000));
      const auto sure = hn::Sub(dot<Tag>(way, n), slack);
      depth = hn::Min(depth, hn::IfThenElse(hn::Eq(sure, sure), sure, hn::Neg(hn::Inf(d))));
    }
    hn::StoreU(depth, d, least + first);
  });
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(BoundDistances);
HWY_EXPORT(BoundDepths);

void bound_distances(std::span<const Vec3d> points, const PlacedTriangles& triangles,
                     std::span<const TrianglePair> list, double* lower, double* upper) {
  HWY_DYNAMIC_DISPATCH(BoundDistances)(points.data(), triangles, list.data(), list.size(), lower, upper);
}
void bound_depths(const Vec3d& origin, const Vec3d& normal, const PlacedTriangles& triangles,
                  std::span<const TrianglePair> list, double* least) {
  HWY_DYNAMIC_DISPATCH(BoundDepths)(origin, normal, triangles, list.data(), list.size(), least);
}

}  // namespace supple
#endif
