#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/pair_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <type_traits>

#include "contact/pair_filter.hpp"
#include "geometry/plane_filter.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// The same steps as `classify` and `Chords` of triangle_intersection.cpp, for pairs in general position.

/// The bounds of geometry/plane_filter.hpp, whose proofs hold for single precision likewise: e = 2^-24, and a
/// product that underflows is off by 2^-150 at most.
template <class Scalar>
constexpr Scalar volume_error_of = std::is_same_v<Scalar, float> ? 10 * 0x1p-24f : Scalar(volume_error);
template <class Scalar>
constexpr Scalar underflow_error_of = std::is_same_v<Scalar, float> ? 0x1p-110f : Scalar(underflow_error);

template <class Tag>
struct Vector3 {
  hn::Vec<Tag> x, y, z;
};
template <class Tag>
using Corners = Vector3<Tag>[3];

template <class Tag>
HWY_INLINE Vector3<Tag> subtract(const Vector3<Tag>& a, const Vector3<Tag>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class Tag>
HWY_INLINE hn::Vec<Tag> dot(const Vector3<Tag>& a, const Vector3<Tag>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
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

/// The sides of a triangle's corners against the plane of another.
template <class Tag>
struct Sides {
  hn::Mask<Tag> above[3];
  hn::Mask<Tag> separated, certain;  // all on one side; no corner in doubt

  HWY_INLINE Sides(const Corners<Tag>& plane, const Corners<Tag>& triangle) {
    const Normal<Tag> normal(subtract<Tag>(plane[1], plane[0]), subtract<Tag>(plane[2], plane[0]));
    const auto w0 = subtract<Tag>(triangle[0], plane[0]), w1 = subtract<Tag>(triangle[1], plane[0]),
               w2 = subtract<Tag>(triangle[2], plane[0]);
    const auto bound =
        normal.bound(larger<Tag>(larger<Tag>(absolute<Tag>(w0), absolute<Tag>(w1)), absolute<Tag>(w2)));
    const auto side0 = dot<Tag>(normal.value, w0), side1 = dot<Tag>(normal.value, w1),
               side2 = dot<Tag>(normal.value, w2);
    const auto lowest = hn::Min(hn::Min(side0, side1), side2);
    const auto highest = hn::Max(hn::Max(side0, side1), side2);
    separated = hn::Gt(hn::Max(lowest, hn::Neg(highest)), bound);
    certain = hn::And(hn::Gt(hn::Abs(side0), bound),
                      hn::And(hn::Gt(hn::Abs(side1), bound), hn::Gt(hn::Abs(side2), bound)));
    const auto zero = hn::Zero(Tag());
    above[0] = hn::Gt(side0, zero);
    above[1] = hn::Gt(side1, zero);
    above[2] = hn::Gt(side2, zero);
  }
};

/// Where a triangle that crosses a plane with no corner in it meets the plane: from edge apex-start to edge
/// apex-end.
template <class Tag>
struct Chord {
  Vector3<Tag> apex, start, end;
  hn::Mask<Tag> apex_above;

  HWY_INLINE Chord(const Corners<Tag>& corners, const Sides<Tag>& sides, bool is_b) {
    const auto first_alone = hn::Not(hn::Xor(sides.above[1], sides.above[2]));
    const auto second_alone = hn::Not(hn::Xor(sides.above[0], sides.above[2]));
    const auto pick = [&](int first, int second, int third) HWY_ATTR {
      return select<Tag>(first_alone, corners[first],
                         select<Tag>(second_alone, corners[second], corners[third]));
    };
    apex = pick(0, 1, 2);
    const Vector3<Tag> next = pick(1, 2, 0), last = pick(2, 0, 1);
    // Masks, not numbers: a mask is not a vector on all machines.
    const auto zero = hn::Zero(Tag());
    const auto one = hn::Set(Tag(), hn::TFromD<Tag>(1));
    const auto flag = [&](hn::Mask<Tag> mask) HWY_ATTR { return hn::IfThenElse(mask, one, zero); };
    apex_above =
        hn::Gt(hn::IfThenElse(first_alone, flag(sides.above[0]),
                              hn::IfThenElse(second_alone, flag(sides.above[1]), flag(sides.above[2]))),
               zero);
    const auto forward = is_b ? apex_above : hn::Not(apex_above);
    start = select<Tag>(forward, next, last);
    end = select<Tag>(forward, last, next);
  }
};

/// The volume of the corners, whose sign tells the order of two chords' ends, and what it may be off by.
template <class Tag>
struct Order {
  hn::Vec<Tag> value, bound;

  HWY_INLINE Order(const Chord<Tag>& a, const Vector3<Tag>& corner_a, const Chord<Tag>& b,
                   const Vector3<Tag>& corner_b) {
    const Normal<Tag> normal(subtract<Tag>(corner_a, a.apex), subtract<Tag>(b.apex, a.apex));
    const Vector3<Tag> w = subtract<Tag>(corner_b, a.apex);
    bound = normal.bound(absolute<Tag>(w));
    const auto volume = dot<Tag>(normal.value, w);
    value = hn::IfThenElse(hn::Xor(a.apex_above, b.apex_above), hn::Neg(volume), volume);
  }
  HWY_INLINE hn::Mask<Tag> positive() const { return hn::Gt(value, bound); }
  HWY_INLINE hn::Mask<Tag> negative() const { return hn::Gt(hn::Neg(value), bound); }
};

template <class Tag>
HWY_INLINE std::uint64_t bits_of(hn::Mask<Tag> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Tag(), mask, bytes);
  return std::uint64_t{bytes[0]} | std::uint64_t{bytes[1]} << 8;
}

template <class Scalar>
PairVerdicts filter(const TrianglePairBlock<Scalar>& block, std::size_t count) {
  using Tag = hn::CappedTag<Scalar, 16>;
  const Tag d;
  PairVerdicts verdicts;
  for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
    const auto load = [&](const auto& rows, std::size_t corner) HWY_ATTR {
      return Vector3<Tag>{hn::Load(d, rows[3 * corner] + first), hn::Load(d, rows[3 * corner + 1] + first),
                          hn::Load(d, rows[3 * corner + 2] + first)};
    };
    const Corners<Tag> a{load(block.a, 0), load(block.a, 1), load(block.a, 2)};
    const Corners<Tag> b{load(block.b, 0), load(block.b, 1), load(block.b, 2)};
    const Sides<Tag> of_a(b, a), of_b(a, b);
    const auto separated = hn::Or(of_a.separated, of_b.separated);
    const auto in_general_position = hn::AndNot(separated, hn::And(of_a.certain, of_b.certain));
    auto apart = separated;
    if (!hn::AllFalse(d, in_general_position)) {
      const Chord<Tag> chord_a(a, of_a, false), chord_b(b, of_b, true);
      const Order<Tag> b_start_to_a_end(chord_a, chord_a.end, chord_b, chord_b.start);
      const Order<Tag> b_end_to_a_start(chord_a, chord_a.start, chord_b, chord_b.end);
      const auto beyond = hn::Or(b_start_to_a_end.positive(), b_end_to_a_start.negative());
      const auto overlap = hn::And(b_start_to_a_end.negative(), b_end_to_a_start.positive());
      apart = hn::Or(apart, hn::And(in_general_position, beyond));
      verdicts.crossing |= bits_of<Tag>(hn::And(in_general_position, overlap)) << first;
    }
    verdicts.apart |= bits_of<Tag>(apart) << first;
  }
  if (count < 64) {
    const std::uint64_t asked = (std::uint64_t{1} << count) - 1;
    verdicts.apart &= asked;
    verdicts.crossing &= asked;
  }
  return verdicts;
}

PairVerdicts filter_floats(const TrianglePairBlock<float>& block, std::size_t count) {
  return filter(block, count);
}
PairVerdicts filter_doubles(const TrianglePairBlock<double>& block, std::size_t count) {
  return filter(block, count);
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(filter_floats);
HWY_EXPORT(filter_doubles);

PairVerdicts filter_pairs(const TrianglePairBlock<float>& block, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(filter_floats)(block, count);
}
PairVerdicts filter_pairs(const TrianglePairBlock<double>& block, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(filter_doubles)(block, count);
}

}  // namespace supple
#endif
