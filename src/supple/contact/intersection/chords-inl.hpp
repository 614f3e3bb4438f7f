// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_CONTACT_CHORDS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_CONTACT_CHORDS_INL_HPP
#undef SUPPLE_CONTACT_CHORDS_INL_HPP
#else
#define SUPPLE_CONTACT_CHORDS_INL_HPP
#endif

#include <hwy/highway.h>

#include <type_traits>

#include "geometry/plane_filter.hpp"
#include "geometry/vector3-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The steps are those of `classify` and `Chords` in triangle_intersection.cpp, for pairs in general position.

/// The bounds of geometry/plane_filter.hpp. The proofs there also hold for single precision, with e = 2^-24
/// and an error of at most 2^-150 for a product that underflows.
template <class Scalar>
constexpr Scalar volume_error_of = std::is_same_v<Scalar, float> ? 10 * 0x1p-24f : Scalar(volume_error);
template <class Scalar>
constexpr Scalar underflow_error_of = std::is_same_v<Scalar, float> ? 0x1p-110f : Scalar(underflow_error);

/// u × v, and the sum of the magnitudes of its products.
template <class Tag>
struct Normal {
  Vector3<Tag> value, magnitude;

  HWY_INLINE Normal(const Vector3<Tag>& u, const Vector3<Tag>& v) {
    const Vector3<Tag> left{hn::Mul(u.y, v.z), hn::Mul(u.z, v.x), hn::Mul(u.x, v.y)};
    const Vector3<Tag> right{hn::Mul(u.z, v.y), hn::Mul(u.x, v.z), hn::Mul(u.y, v.x)};
    value = subtract<Tag>(left, right);
    magnitude = {hn::Add(hn::Abs(left.x), hn::Abs(right.x)), hn::Add(hn::Abs(left.y), hn::Abs(right.y)),
                 hn::Add(hn::Abs(left.z), hn::Abs(right.z))};
  }
  /// What the volume with any w may be off by, |w| being at most `reach` along each axis.
  HWY_INLINE hn::Vec<Tag> bound(const Vector3<Tag>& reach) const {
    using Scalar = hn::TFromD<Tag>;
    const auto underflow = hn::Set(Tag(), underflow_error_of<Scalar>);
    const auto rounding = hn::Mul(hn::Set(Tag(), volume_error_of<Scalar>), dot<Tag>(magnitude, reach));
    return hn::Add(hn::Add(rounding, hn::Mul(underflow, hn::Add(hn::Add(reach.x, reach.y), reach.z))),
                   underflow);
  }
};

/// The corners of a triangle against the plane of another: six times the volumes, and a bound of their
/// errors.
template <class Tag>
struct Sides {
  hn::Vec<Tag> side[3], bound;

  HWY_INLINE Sides(const Corners<Tag>& plane, const Corners<Tag>& triangle) {
    const Normal<Tag> normal(subtract<Tag>(plane[1], plane[0]), subtract<Tag>(plane[2], plane[0]));
    const auto w0 = subtract<Tag>(triangle[0], plane[0]), w1 = subtract<Tag>(triangle[1], plane[0]),
               w2 = subtract<Tag>(triangle[2], plane[0]);
    bound = normal.bound(larger<Tag>(larger<Tag>(absolute<Tag>(w0), absolute<Tag>(w1)), absolute<Tag>(w2)));
    side[0] = dot<Tag>(normal.value, w0);
    side[1] = dot<Tag>(normal.value, w1);
    side[2] = dot<Tag>(normal.value, w2);
  }
  /// All corners are on one side.
  HWY_INLINE hn::Mask<Tag> separated() const {
    const auto lowest = hn::Min(hn::Min(side[0], side[1]), side[2]);
    const auto highest = hn::Max(hn::Max(side[0], side[1]), side[2]);
    return hn::Gt(hn::Max(lowest, hn::Neg(highest)), bound);
  }
  /// No corner is in doubt.
  HWY_INLINE hn::Mask<Tag> certain() const {
    return hn::And(hn::Gt(hn::Abs(side[0]), bound),
                   hn::And(hn::Gt(hn::Abs(side[1]), bound), hn::Gt(hn::Abs(side[2]), bound)));
  }
};

/// A corner and its side of the plane of the other triangle.
template <class Tag>
struct SidedCorner {
  Vector3<Tag> position;
  hn::Vec<Tag> side;
};
template <class Tag>
HWY_INLINE SidedCorner<Tag> select(hn::Mask<Tag> mask, const SidedCorner<Tag>& yes,
                                   const SidedCorner<Tag>& no) {
  return {select<Tag>(mask, yes.position, no.position), hn::IfThenElse(mask, yes.side, no.side)};
}

/// The chord in which a triangle meets a plane that contains none of its corners. It runs from the edge
/// apex-start to the edge apex-end.
template <class Tag>
struct Chord {
  SidedCorner<Tag> apex, start, end;
  hn::Mask<Tag> first_alone, second_alone;  // which corner is the apex; otherwise the third
  hn::Mask<Tag> apex_above;
  hn::Mask<Tag> forward;  // `start` is the corner after the apex

  HWY_INLINE Chord(const Corners<Tag>& corners, const Sides<Tag>& sides, bool is_b) {
    const auto zero = hn::Zero(Tag());
    const auto above0 = hn::Gt(sides.side[0], zero), above1 = hn::Gt(sides.side[1], zero),
               above2 = hn::Gt(sides.side[2], zero);
    first_alone = hn::Not(hn::Xor(above1, above2));
    second_alone = hn::Not(hn::Xor(above0, above2));
    const SidedCorner<Tag> corner[] = {
        {corners[0], sides.side[0]}, {corners[1], sides.side[1]}, {corners[2], sides.side[2]}};
    const auto pick = [&](int first, int second, int third) HWY_ATTR {
      return select<Tag>(first_alone, corner[first],
                         select<Tag>(second_alone, corner[second], corner[third]));
    };
    apex = pick(0, 1, 2);
    const SidedCorner<Tag> next = pick(1, 2, 0), last = pick(2, 0, 1);
    apex_above = hn::Gt(apex.side, zero);
    forward = is_b ? apex_above : hn::Not(apex_above);
    start = select<Tag>(forward, next, last);
    end = select<Tag>(forward, last, next);
  }
};

/// The volume of the corners and its error bound. The sign of the volume is the order of two ends of chords.
template <class Tag>
struct Order {
  hn::Vec<Tag> value, bound;

  HWY_INLINE Order(const Chord<Tag>& a, const SidedCorner<Tag>& corner_a, const Chord<Tag>& b,
                   const SidedCorner<Tag>& corner_b) {
    const Vector3<Tag>& origin = a.apex.position;
    const Normal<Tag> normal(subtract<Tag>(corner_a.position, origin),
                             subtract<Tag>(b.apex.position, origin));
    const Vector3<Tag> w = subtract<Tag>(corner_b.position, origin);
    bound = normal.bound(absolute<Tag>(w));
    const auto volume = dot<Tag>(normal.value, w);
    value = hn::IfThenElse(hn::Xor(a.apex_above, b.apex_above), hn::Neg(volume), volume);
  }
  HWY_INLINE hn::Mask<Tag> positive() const { return hn::Gt(value, bound); }
  HWY_INLINE hn::Mask<Tag> negative() const { return hn::Gt(hn::Neg(value), bound); }
};

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
