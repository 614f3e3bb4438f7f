// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_CONTACT_DOUBLE_DOUBLE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_CONTACT_DOUBLE_DOUBLE_INL_HPP
#undef SUPPLE_CONTACT_DOUBLE_DOUBLE_INL_HPP
#else
#define SUPPLE_CONTACT_DOUBLE_DOUBLE_INL_HPP
#endif

#include <hwy/highway.h>

#include "geometry/vector3-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Doubles = hn::Vec<Lanes>;
using LaneMask = hn::Mask<Lanes>;
using Vector = Vector3<Lanes>;

HWY_INLINE Doubles constant(double value) {
  return hn::Set(Lanes(), value);
}

/// `DoubleDouble` in each lane, with the same operations.
struct Pairs {
  Doubles high, low;
};

HWY_INLINE Pairs exact_sum(Doubles a, Doubles b) {
  const Doubles sum = hn::Add(a, b), of_b = hn::Sub(sum, a);
  return {sum, hn::Add(hn::Sub(a, hn::Sub(sum, of_b)), hn::Sub(b, of_b))};
}
HWY_INLINE Pairs exact_sum_of_ordered(Doubles a, Doubles b) {
  const Doubles sum = hn::Add(a, b);
  return {sum, hn::Sub(b, hn::Sub(sum, a))};
}
HWY_INLINE Pairs exact_product(Doubles a, Doubles b) {
  const Doubles splitter = constant(0x1p27 + 1);
  const Doubles pa = hn::Mul(splitter, a), pb = hn::Mul(splitter, b);
  const Doubles a_high = hn::Sub(pa, hn::Sub(pa, a)), b_high = hn::Sub(pb, hn::Sub(pb, b));
  const Doubles a_low = hn::Sub(a, a_high), b_low = hn::Sub(b, b_high), product = hn::Mul(a, b);
  const Doubles first = hn::Sub(hn::Mul(a_high, b_high), product);
  return {product, hn::Add(hn::Add(hn::Add(first, hn::Mul(a_high, b_low)), hn::Mul(a_low, b_high)),
                           hn::Mul(a_low, b_low))};
}
HWY_INLINE Pairs add(const Pairs& a, const Pairs& b) {
  const Pairs high = exact_sum(a.high, b.high), low = exact_sum(a.low, b.low);
  const Pairs sum = exact_sum_of_ordered(high.high, hn::Add(high.low, low.high));
  return exact_sum_of_ordered(sum.high, hn::Add(sum.low, low.low));
}
HWY_INLINE Pairs subtract(const Pairs& a, const Pairs& b) {
  return add(a, {hn::Neg(b.high), hn::Neg(b.low)});
}
HWY_INLINE Pairs multiply(const Pairs& a, const Pairs& b) {
  const Pairs product = exact_product(a.high, b.high);
  return exact_sum_of_ordered(product.high,
                              hn::Add(product.low, hn::Add(hn::Mul(a.high, b.low), hn::Mul(a.low, b.high))));
}
HWY_INLINE Doubles rounded(const Pairs& a) {
  return hn::Add(a.high, a.low);
}

struct PairsVector {
  Pairs x, y, z;
};
HWY_INLINE PairsVector exact_difference(const Vector& p, const Vector& q) {
  return {exact_sum(p.x, hn::Neg(q.x)), exact_sum(p.y, hn::Neg(q.y)), exact_sum(p.z, hn::Neg(q.z))};
}
HWY_NOINLINE Pairs dot(const PairsVector& a, const PairsVector& b) {
  return add(add(multiply(a.x, b.x), multiply(a.y, b.y)), multiply(a.z, b.z));
}
HWY_NOINLINE PairsVector cross(const PairsVector& a, const PairsVector& b) {
  return {subtract(multiply(a.y, b.z), multiply(a.z, b.y)), subtract(multiply(a.z, b.x), multiply(a.x, b.z)),
          subtract(multiply(a.x, b.y), multiply(a.y, b.x))};
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
