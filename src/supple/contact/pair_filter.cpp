#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/pair_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "contact/pair_filter.hpp"
#include "core/packed_lanes-inl.hpp"
#include "geometry/plane_filter.hpp"
#include "geometry/vector3-inl.hpp"
#include "mesh/vertex_loads-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

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

/// The chord in which a triangle meets a plane that contains none of its corners. It runs from the edge
/// apex-start to the edge apex-end.
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
    // Selects numbers, because not all machines can select masks.
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

/// The volume of the corners and its error bound. The sign of the volume is the order of two ends of chords.
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

// Reading corners. A register has blocks of 16 bytes: four floats or two doubles. The functions below read
// corners into blocks and transpose them there, so that each register gets one coordinate of as many pairs as
// it has lanes.

#if HWY_TARGET == HWY_SCALAR

/// The corners of one triangle. The vector version below does the same for several pairs.
template <std::uint32_t TrianglePair::*side, class Tag, class Source>
HWY_INLINE void read_corners(VertexArray<Source> vertices, const PlacedTriangles& source,
                             const TrianglePair* pairs, Corners<Tag>& corners) {
  using Scalar = hn::TFromD<Tag>;
  const Vec3d& t = source.translation;
  for (int i = 0; i < 3; ++i) {
    const Source* const p = vertices[source.arrays.triangles[pairs->*side][i]];
    corners[i] = {hn::Set(Tag(), Scalar(p[0])), hn::Set(Tag(), Scalar(p[1])), hn::Set(Tag(), Scalar(p[2]))};
    if constexpr (std::is_same_v<Scalar, double>) {
      corners[i] = {hn::Add(corners[i].x, hn::Set(Tag(), t.x)), hn::Add(corners[i].y, hn::Set(Tag(), t.y)),
                    hn::Add(corners[i].z, hn::Set(Tag(), t.z))};
    }
  }
}

#else

/// One register for each corner.
template <class Tag>
struct CornerBlocks {
  hn::Vec<Tag> corner[3];
};

/// Reads the corners of every `step`th pair, one block for each, by `read(position)`.
template <std::uint32_t TrianglePair::*side, class Tag, std::size_t step, class Source, class Read>
HWY_INLINE CornerBlocks<Tag> read_blocks(VertexArray<Source> vertices, const Triangle* triangles,
                                         const TrianglePair* pairs, const Read& read) {
  constexpr std::size_t blocks = hn::MaxLanes(Tag()) * sizeof(hn::TFromD<Tag>) / 16;
  if constexpr (blocks == 1) {
    const Triangle& triangle = triangles[pairs->*side];
    return {{read(vertices[triangle[0]]), read(vertices[triangle[1]]), read(vertices[triangle[2]])}};
  } else {
    using Half = hn::Half<Tag>;
    const Tag d;
    const auto lower = read_blocks<side, Half, step>(vertices, triangles, pairs, read);
    const auto upper = read_blocks<side, Half, step>(vertices, triangles, pairs + step * (blocks / 2), read);
    return {{hn::Combine(d, upper.corner[0], lower.corner[0]),
             hn::Combine(d, upper.corner[1], lower.corner[1]),
             hn::Combine(d, upper.corner[2], lower.corner[2])}};
  }
}

// These are not lambdas, because builds without optimisation do not inline lambdas.

struct FourFloats {
  HWY_INLINE auto operator()(const float* position) const { return load_vertex(position); }
};
/// Reads x and y as doubles.
struct TwoDoubles {
  HWY_INLINE auto operator()(const double* position) const {
    return hn::LoadU(hn::FixedTag<double, 2>(), position);
  }
  HWY_INLINE auto operator()(const float* position) const {
    return hn::PromoteTo(hn::FixedTag<double, 2>(), hn::LoadU(hn::FixedTag<float, 2>(), position));
  }
};
/// Reads z into both lanes.
struct DoubleZ {
  template <class Source>
  HWY_INLINE auto operator()(const Source* position) const {
    return hn::Set(hn::FixedTag<double, 2>(), double{position[2]});
  }
};

template <std::uint32_t TrianglePair::*side, class Tag>
HWY_INLINE void read_floats(VertexArray<float> vertices, const Triangle* triangles, const TrianglePair* pairs,
                            Corners<Tag>& corners) {
  const Tag d;
  const FourFloats read;
  const auto v0 = read_blocks<side, Tag, 4>(vertices, triangles, pairs, read);
  const auto v1 = read_blocks<side, Tag, 4>(vertices, triangles, pairs + 1, read);
  const auto v2 = read_blocks<side, Tag, 4>(vertices, triangles, pairs + 2, read);
  const auto v3 = read_blocks<side, Tag, 4>(vertices, triangles, pairs + 3, read);
  for (int i = 0; i < 3; ++i) {
    const auto xy_even = hn::InterleaveLower(d, v0.corner[i], v2.corner[i]);
    const auto xy_odd = hn::InterleaveLower(d, v1.corner[i], v3.corner[i]);
    const auto z_even = hn::InterleaveUpper(d, v0.corner[i], v2.corner[i]);
    const auto z_odd = hn::InterleaveUpper(d, v1.corner[i], v3.corner[i]);
    corners[i] = {hn::InterleaveLower(d, xy_even, xy_odd), hn::InterleaveUpper(d, xy_even, xy_odd),
                  hn::InterleaveLower(d, z_even, z_odd)};
  }
}

template <std::uint32_t TrianglePair::*side, class Tag, class Source>
HWY_INLINE void read_doubles(VertexArray<Source> vertices, const PlacedTriangles& source,
                             const TrianglePair* pairs, Corners<Tag>& corners) {
  const Tag d;
  const Triangle* const triangles = source.arrays.triangles;
  const TwoDoubles read_xy;
  const DoubleZ read_z;
  const auto xy_even = read_blocks<side, Tag, 2>(vertices, triangles, pairs, read_xy);
  const auto xy_odd = read_blocks<side, Tag, 2>(vertices, triangles, pairs + 1, read_xy);
  const auto z_even = read_blocks<side, Tag, 2>(vertices, triangles, pairs, read_z);
  const auto z_odd = read_blocks<side, Tag, 2>(vertices, triangles, pairs + 1, read_z);
  const auto tx = hn::Set(d, source.translation.x), ty = hn::Set(d, source.translation.y),
             tz = hn::Set(d, source.translation.z);
  for (int i = 0; i < 3; ++i) {
    corners[i] = {hn::Add(hn::InterleaveLower(d, xy_even.corner[i], xy_odd.corner[i]), tx),
                  hn::Add(hn::InterleaveUpper(d, xy_even.corner[i], xy_odd.corner[i]), ty),
                  hn::Add(hn::InterleaveLower(d, z_even.corner[i], z_odd.corner[i]), tz)};
  }
}

template <std::uint32_t TrianglePair::*side, class Tag, class Source>
HWY_INLINE void read_corners(VertexArray<Source> vertices, const PlacedTriangles& source,
                             const TrianglePair* pairs, Corners<Tag>& corners) {
  if constexpr (std::is_same_v<hn::TFromD<Tag>, float>) {
    read_floats<side, Tag>(vertices, source.arrays.triangles, pairs, corners);
  } else {
    read_doubles<side, Tag>(vertices, source, pairs, corners);
  }
}

#endif

/// Verdicts on as many pairs as there are lanes.
template <class Tag>
HWY_INLINE void decide(const Corners<Tag>& a, const Corners<Tag>& b, std::size_t first,
                       PairVerdicts& verdicts) {
  const Tag d;
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
    verdicts.crossing |= mask_bits(d, hn::And(in_general_position, overlap)) << first;
  }
  verdicts.apart |= mask_bits(d, apart) << first;
}

template <class Scalar, class SourceA, class SourceB>
HWY_INLINE PairVerdicts filter(VertexArray<SourceA> vertices_a, VertexArray<SourceB> vertices_b,
                               const PlacedTriangles& a, const PlacedTriangles& b, const TrianglePair* pairs,
                               std::size_t count) {
  using Tag = hn::CappedTag<Scalar, 16>;
  const std::size_t lanes = hn::Lanes(Tag());
  PairVerdicts verdicts;
  std::array<TrianglePair, 16> last;
  for (std::size_t first = 0; first < count; first += lanes) {
    const TrianglePair* part = pairs + first;
    if (count - first < lanes) {
      last.fill(pairs[first]);
      std::copy(part, pairs + count, last.begin());
      part = last.data();
    }
    Corners<Tag> corners_a, corners_b;
    read_corners<&TrianglePair::a, Tag>(vertices_a, a, part, corners_a);
    read_corners<&TrianglePair::b, Tag>(vertices_b, b, part, corners_b);
    decide<Tag>(corners_a, corners_b, first, verdicts);
  }
  if (count < pair_filter_capacity) {
    const std::uint64_t in_use = (std::uint64_t{1} << count) - 1;
    verdicts.apart &= in_use;
    verdicts.crossing &= in_use;
  }
  return verdicts;
}

PairVerdicts filter_floats(const PlacedTriangles& a, const PlacedTriangles& b, const TrianglePair* pairs,
                           std::size_t count) {
  return filter<float>(a.arrays.floats, b.arrays.floats, a, b, pairs, count);
}
PairVerdicts filter_doubles(const PlacedTriangles& a, const PlacedTriangles& b, const TrianglePair* pairs,
                            std::size_t count) {
  if (a.arrays.doubles.data == nullptr && b.arrays.doubles.data == nullptr)
    return filter<double>(a.arrays.floats, b.arrays.floats, a, b, pairs, count);
  if (a.arrays.doubles.data == nullptr)
    return filter<double>(a.arrays.floats, b.arrays.doubles, a, b, pairs, count);
  if (b.arrays.doubles.data == nullptr)
    return filter<double>(a.arrays.doubles, b.arrays.floats, a, b, pairs, count);
  return filter<double>(a.arrays.doubles, b.arrays.doubles, a, b, pairs, count);
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(filter_floats);
HWY_EXPORT(filter_doubles);

PairVerdicts filter_pairs(const PlacedTriangles& a, const PlacedTriangles& b,
                          std::span<const TrianglePair> pairs) {
  const auto is_single = [](const PlacedTriangles& triangles) {
    return triangles.arrays.floats.data != nullptr && triangles.translation == Vec3d{};
  };
  if (is_single(a) && is_single(b))
    return HWY_DYNAMIC_DISPATCH(filter_floats)(a, b, pairs.data(), pairs.size());
  return HWY_DYNAMIC_DISPATCH(filter_doubles)(a, b, pairs.data(), pairs.size());
}

}  // namespace supple
#endif
