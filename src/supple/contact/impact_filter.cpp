#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/impact_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "contact/impact_filter.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// At most sixteen lanes, so that their mask is two bytes.
using Lanes = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Lanes>;
using LaneMask = hn::Mask<Lanes>;

struct Vector3 {
  Vector x, y, z;
};

HWY_INLINE Vector3 load(const RelativeMotionBlock& block, std::size_t row, std::size_t first) {
  const Lanes d;
  return {hn::Load(d, block.rows[row] + first), hn::Load(d, block.rows[row + 1] + first),
          hn::Load(d, block.rows[row + 2] + first)};
}
HWY_INLINE Vector3 add(const Vector3& a, const Vector3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vector3 subtract(const Vector3& a, const Vector3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vector3 scaled(const Vector3& a, Vector s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE Vector dot(const Vector3& a, const Vector3& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}
HWY_INLINE Vector3 cross(const Vector3& a, const Vector3& b) {
  return {hn::NegMulAdd(a.z, b.y, hn::Mul(a.y, b.z)), hn::NegMulAdd(a.x, b.z, hn::Mul(a.z, b.x)),
          hn::NegMulAdd(a.y, b.x, hn::Mul(a.x, b.y))};
}
HWY_INLINE Vector3 absolute(const Vector3& a) {
  return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}
HWY_INLINE Vector3 larger(const Vector3& a, const Vector3& b) {
  return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)};
}
HWY_INLINE Vector sum(const Vector3& a) {
  return hn::Add(hn::Add(a.x, a.y), a.z);
}

struct Places {
  Vector3 m, u, w;
};

/// Tests on one vector of pairs. Each test proves for some lanes that the elements stay apart.
class Group {
 public:
  HWY_INLINE Group(const RelativeMotionBlock& block, std::size_t first, bool is_square, float separation)
      : is_square_(is_square), separation_(hn::Set(Lanes(), separation)) {
    using Row = RelativeMotionBlock;
    start_ = {load(block, Row::m, first), load(block, Row::u, first), load(block, Row::w, first)};
    end_ = {load(block, Row::end + Row::m, first), load(block, Row::end + Row::u, first),
            load(block, Row::end + Row::w, first)};
    reach_m_ = larger(absolute(start_.m), absolute(end_.m));
    reach_u_ = larger(absolute(start_.u), absolute(end_.u));
    reach_w_ = larger(absolute(start_.w), absolute(end_.w));
    reach_ = add(add(reach_m_, reach_u_), reach_w_);
  }

  /// Whether all differences lie on one side of the plane through the origin with normal n, by more than the
  /// separation, at both ends of the step and so throughout.
  ///
  /// The three products of a dot product, the roundings of the coordinates (2^-24 each) and of the two sums
  /// make an error below 6 · 2^-24 of the magnitudes' sum. The extent of the elements adds two more terms and
  /// roundings. 2^-20 covers all of these and the rounding of the bound; the constants cover underflow.
  /// Overflow makes the bound infinite or NaN, and the comparison false.
  HWY_NOINLINE LaneMask separated_along(const Vector3& n) const {
    const Lanes d;
    const Vector size = sum(absolute(n));
    const Vector tiny = hn::Set(d, 0x1p-110f);
    Vector bound = hn::MulAdd(hn::Set(d, 0x1p-20f), dot(absolute(n), reach_), hn::MulAdd(tiny, size, tiny));
    // The addend covers squares that underflow.
    const Vector length =
        hn::Mul(hn::Sqrt(hn::Add(dot(n, n), hn::Set(d, 0x1p-100f))), hn::Set(d, 1 + 0x1p-20f));
    bound = hn::MulAdd(separation_, length, bound);
    const Vector sm0 = dot(n, start_.m), sm1 = dot(n, end_.m);
    const Vector su0 = dot(n, start_.u), su1 = dot(n, end_.u);
    const Vector sw0 = dot(n, start_.w), sw1 = dot(n, end_.w);
    const Vector above = hn::Min(hn::Sub(sm0, extent(su0, sw0)), hn::Sub(sm1, extent(su1, sw1)));
    const Vector below = hn::Max(hn::Add(sm0, extent(hn::Neg(su0), hn::Neg(sw0))),
                                 hn::Add(sm1, extent(hn::Neg(su1), hn::Neg(sw1))));
    return hn::Gt(hn::Max(above, hn::Neg(below)), bound);
  }

  /// Whether the tetrahedron of the four vertices never becomes flat: all Bernstein coefficients of its
  /// volume have one sign. With a separation, its height over the plane of u and w must stay above the
  /// separation.
  ///
  /// Coordinates, minors, products and sums take part in at most 12 roundings of 2^-24; 2^-19 is more than
  /// twice that. Eight times the magnitudes overflow before any sum does.
  HWY_NOINLINE LaneMask never_coplanar() const {
    const Lanes d;
    const Vector third = hn::Set(d, 1.0f / 3.0f), half = hn::Set(d, 0.5f);
    const Vector3 n0 = cross(start_.u, start_.w), n2 = cross(end_.u, end_.w);
    const Vector3 twice_n1 = add(cross(start_.u, end_.w), cross(end_.u, start_.w));
    const Vector c0 = dot(start_.m, n0), c3 = dot(end_.m, n2);
    const Vector c1 = hn::Mul(third, hn::Add(dot(end_.m, n0), dot(start_.m, twice_n1)));
    const Vector c2 = hn::Mul(third, hn::Add(dot(start_.m, n2), dot(end_.m, twice_n1)));
    const Vector least = hn::Min(hn::Min(c0, c1), hn::Min(c2, c3));
    const Vector most = hn::Max(hn::Max(c0, c1), hn::Max(c2, c3));
    const Vector3 minors{hn::MulAdd(reach_u_.y, reach_w_.z, hn::Mul(reach_u_.z, reach_w_.y)),
                         hn::MulAdd(reach_u_.z, reach_w_.x, hn::Mul(reach_u_.x, reach_w_.z)),
                         hn::MulAdd(reach_u_.x, reach_w_.y, hn::Mul(reach_u_.y, reach_w_.x))};
    const Vector tiny = hn::Set(d, 0x1p-100f);
    const Vector magnitude = hn::Mul(hn::Set(d, 8.0f), dot(minors, reach_m_));
    Vector bound = hn::MulAdd(hn::Set(d, 0x1p-22f), magnitude, hn::MulAdd(tiny, sum(reach_), tiny));
    const Vector area =
        hn::Max(sum(absolute(n0)), hn::Max(sum(absolute(n2)), hn::Mul(half, sum(absolute(twice_n1)))));
    bound =
        hn::MulAdd(separation_, hn::MulAdd(hn::Set(d, 0x1p-19f), sum(minors), hn::Add(area, tiny)), bound);
    return hn::Gt(hn::Max(least, hn::Neg(most)), bound);
  }

  HWY_INLINE LaneMask apart() const {
    const Lanes d;
    const Vector3 m = add(start_.m, end_.m), u = add(start_.u, end_.u), w = add(start_.w, end_.w);
    const Vector3 n = cross(u, w);
    LaneMask result = separated_along(n);
    result = hn::Or(result, never_coplanar());
    result = hn::Or(result, separated_along(cross(u, n)));
    result = hn::Or(result, separated_along(cross(w, n)));
    if (hn::AllTrue(d, result)) return result;
    if (!is_square_) result = hn::Or(result, separated_along(cross(subtract(w, u), n)));
    result = hn::Or(result, separated_along(m));
    result = hn::Or(result, separated_along(subtract(scaled(m, dot(u, u)), scaled(u, dot(m, u)))));
    result = hn::Or(result, separated_along(subtract(scaled(m, dot(w, w)), scaled(w, dot(m, w)))));
    if (hn::AllTrue(d, result)) return result;
    const Vector3 velocity = subtract(end_.m, start_.m);
    result = hn::Or(result, separated_along(cross(velocity, u)));
    result = hn::Or(result, separated_along(cross(velocity, w)));
    result = hn::Or(result, separated_along(cross(start_.u, start_.w)));
    return hn::Or(result, separated_along(cross(end_.u, end_.w)));
  }

 private:
  /// The greatest value of alpha su + beta sw over the domain.
  HWY_INLINE Vector extent(Vector su, Vector sw) const {
    const Vector zero = hn::Zero(Lanes());
    const Vector positive_u = hn::Max(su, zero), positive_w = hn::Max(sw, zero);
    return is_square_ ? hn::Add(positive_u, positive_w) : hn::Max(positive_u, positive_w);
  }

  bool is_square_;
  Vector separation_;
  Places start_, end_;
  Vector3 reach_m_, reach_u_, reach_w_, reach_;  // greatest magnitudes in the step, by axis
};

std::uint64_t MayTouch(const RelativeMotionBlock& block, std::size_t count, bool is_square,
                       float separation) {
  const Lanes d;
  std::uint64_t apart = 0;
  for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, Group(block, first, is_square, separation).apart(), bits);
    apart |= (std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8) << first;
  }
  return ~apart & (count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0});
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(MayTouch);

std::uint64_t may_touch(const RelativeMotionBlock& block, std::size_t count, bool is_square,
                        float separation) {
  return HWY_DYNAMIC_DISPATCH(MayTouch)(block, count, is_square, separation);
}

void RelativeMotionBlock::set(std::size_t pair, const RelativeMotion& motion) {
  const auto rounded = [](const Vec3d& v) {
    return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  const auto set_places = [&](std::size_t row, const RelativePlaces<double>& places) {
    set(pair, row + m, rounded(places.m));
    set(pair, row + u, rounded(places.u));
    set(pair, row + w, rounded(places.w));
  };
  set_places(0, motion.start);
  set_places(end, motion.end);
}

}  // namespace supple
#endif
