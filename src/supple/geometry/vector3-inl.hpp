// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_GEOMETRY_VECTOR3_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_GEOMETRY_VECTOR3_INL_HPP
#undef SUPPLE_GEOMETRY_VECTOR3_INL_HPP
#else
#define SUPPLE_GEOMETRY_VECTOR3_INL_HPP
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One `Vec3` in each SIMD lane. The operations round like those of `Vec3`.
template <class Tag>
struct Vector3 {
  hn::Vec<Tag> x, y, z;
};
template <class Tag>
using Corners = Vector3<Tag>[3];

template <class Tag>
HWY_INLINE Vector3<Tag> add(const Vector3<Tag>& a, const Vector3<Tag>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class Tag>
HWY_INLINE Vector3<Tag> subtract(const Vector3<Tag>& a, const Vector3<Tag>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class Tag>
HWY_INLINE Vector3<Tag> scaled(const Vector3<Tag>& v, hn::Vec<Tag> s) {
  return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)};
}
template <class Tag>
HWY_INLINE hn::Vec<Tag> dot(const Vector3<Tag>& a, const Vector3<Tag>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class Tag>
HWY_INLINE Vector3<Tag> cross(const Vector3<Tag>& a, const Vector3<Tag>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
template <class Tag>
HWY_INLINE Vector3<Tag> absolute(const Vector3<Tag>& v) {
  return {hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z)};
}
template <class Tag>
HWY_INLINE Vector3<Tag> larger(const Vector3<Tag>& a, const Vector3<Tag>& b) {
  return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)};
}
template <class Tag>
HWY_INLINE Vector3<Tag> select(hn::Mask<Tag> mask, const Vector3<Tag>& yes, const Vector3<Tag>& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
