// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_CONTACT_SEPARATING_NORMAL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_CONTACT_SEPARATING_NORMAL_INL_HPP
#undef SUPPLE_CONTACT_SEPARATING_NORMAL_INL_HPP
#else
#define SUPPLE_CONTACT_SEPARATING_NORMAL_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <limits>

#include "geometry/vector3-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Squared sine of an angle below which two edges count as parallel.
constexpr double parallel_squared_sine = 0x1p-40;
/// Squared distance from a plane, relative to the squared size, below which triangles count as coplanar.
constexpr double flat_squared_distance = 0x1p-64;
/// Directions of a smaller squared length have lost bits to underflow.
constexpr double least_squared_length = 0x1p-900;
/// Within this range the tenth power of a size, the largest product below, neither overflows nor vanishes.
constexpr double least_size = 0x1p-80, most_size = 0x1p80;

template <class Tag>
HWY_INLINE hn::Vec<Tag> squared_norm(const Vector3<Tag>& v) {
  return dot<Tag>(v, v);
}
template <class Doubles>
HWY_INLINE Doubles least_of(Doubles p, Doubles q, Doubles r) {
  return hn::Min(hn::Min(p, q), r);
}
template <class Doubles>
HWY_INLINE Doubles most_of(Doubles p, Doubles q, Doubles r) {
  return hn::Max(hn::Max(p, q), r);
}

/// One triangle of each pair, relative to an origin near it.
template <class Tag>
struct EdgesAndNormal {
  Corners<Tag> corners, edges;  // edge i goes from corner i to the next one
  hn::Vec<Tag> squared_lengths[3];
  hn::Mask<Tag> is_long[3];  // short edges of segments point anywhere
  /// Edges of squared length s are parallel to edge i when their product has at most parallel[i] s.
  hn::Vec<Tag> parallel[3];
  Vector3<Tag> normal;
  hn::Vec<Tag> squared_normal;
  hn::Mask<Tag> has_area;  // the others count as segments or points

  HWY_INLINE EdgesAndNormal(const Corners<Tag>& positions, const Vector3<Tag>& origin) {
    for (std::size_t i = 0; i < 3; ++i) corners[i] = subtract<Tag>(positions[i], origin);
    for (std::size_t i = 0; i < 3; ++i) {
      edges[i] = subtract<Tag>(corners[(i + 1) % 3], corners[i]);
      squared_lengths[i] = squared_norm<Tag>(edges[i]);
    }
    normal = cross<Tag>(edges[0], edges[1]);
    squared_normal = squared_norm<Tag>(normal);
    const auto& [s, t, u] = squared_lengths;
    const auto squared_sine = hn::Set(Tag(), parallel_squared_sine);
    const auto infinity = hn::Set(Tag(), std::numeric_limits<double>::infinity());
    const auto least_long = hn::Mul(squared_sine, most_of(s, t, u));
    for (std::size_t i = 0; i < 3; ++i) {
      is_long[i] = hn::Gt(squared_lengths[i], least_long);
      parallel[i] = hn::IfThenElse(is_long[i], hn::Mul(squared_sine, squared_lengths[i]), infinity);
    }
    has_area =
        hn::Gt(squared_normal, hn::Mul(squared_sine, most_of(hn::Mul(s, t), hn::Mul(t, u), hn::Mul(u, s))));
  }

  HWY_INLINE hn::Vec<Tag> size() const {
    const Vector3<Tag> largest = larger<Tag>(
        larger<Tag>(absolute<Tag>(corners[0]), absolute<Tag>(corners[1])), absolute<Tag>(corners[2]));
    return most_of(largest.x, largest.y, largest.z);
  }

  /// The lowest and the highest corner of other triangles above the planes of these, in lengths of the
  /// normals.
  HWY_INLINE void heights(const EdgesAndNormal& other, hn::Vec<Tag>& least, hn::Vec<Tag>& most) const {
    const auto height = [&](int i) HWY_ATTR {
      return dot<Tag>(normal, subtract<Tag>(other.corners[i], corners[0]));
    };
    const auto p = height(0), q = height(1), r = height(2);
    least = least_of(p, q, r);
    most = most_of(p, q, r);
  }
};

/// The best of the directions considered so far. Depths along a direction are multiples of its length.
///
/// Along a direction the two triangles cover intervals. `offset` is twice the distance of their middles,
/// from a to b, and `extent` the sum of their lengths. To separate them, a has to move by half of
/// extent + offset along the direction, or by half of extent - offset against it.
template <class Tag>
struct LeastPenetration {
  hn::Vec<Tag> flat, squared_depth, squared_length, offset;
  Vector3<Tag> direction;
  hn::Mask<Tag> is_flat;

  HWY_INLINE explicit LeastPenetration(hn::Vec<Tag> size) {
    const auto zero = hn::Zero(Tag());
    // `extent` and `offset` are twice as long as the ways, hence the 4.
    flat = hn::Mul(hn::Mul(hn::Set(Tag(), 4 * flat_squared_distance), size), size);
    squared_depth = hn::Set(Tag(), 1.0);  // over no length: infinitely deep
    squared_length = zero;
    offset = zero;
    direction = {zero, zero, zero};
    is_flat = hn::Gt(zero, zero);
  }

  HWY_INLINE void consider(hn::Mask<Tag> is_valid, const Vector3<Tag>& candidate,
                           hn::Vec<Tag> squared_candidate, hn::Vec<Tag> candidate_offset,
                           hn::Vec<Tag> extent) {
    const auto distance = hn::Abs(candidate_offset);
    const auto depth = hn::Max(hn::Sub(extent, distance), hn::Zero(Tag()));
    const auto most = hn::Add(extent, distance);
    const auto squared = hn::Mul(depth, depth);
    const auto is_less = hn::Lt(hn::Mul(squared, squared_length), hn::Mul(squared_depth, squared_candidate));
    const auto makes_flat = hn::Le(hn::Mul(most, most), hn::Mul(flat, squared_candidate));
    const auto is_better = hn::And(hn::AndNot(is_flat, is_valid), is_less);
    direction = select<Tag>(is_better, candidate, direction);
    offset = hn::IfThenElse(is_better, candidate_offset, offset);
    squared_depth = hn::IfThenElse(is_better, squared, squared_depth);
    squared_length = hn::IfThenElse(is_better, squared_candidate, squared_length);
    is_flat = hn::Or(is_flat, hn::And(is_better, makes_flat));
  }

  /// Towards the side to which a has the shorter way; in a plane, along the direction itself.
  HWY_INLINE Vector3<Tag> unit_normal() const {
    const auto is_backward = hn::AndNot(is_flat, hn::Gt(offset, hn::Zero(Tag())));
    const auto length = hn::Sqrt(squared_length);
    const auto divisor = hn::IfThenElse(is_backward, hn::Neg(length), length);
    return {hn::Div(direction.x, divisor), hn::Div(direction.y, divisor), hn::Div(direction.z, divisor)};
  }
};

/// Unit normals of `TriangleIntersection`. Returns the lanes that have one. The triangles of the others are
/// too large or too small, or lie on one line.
template <class Tag>
HWY_INLINE hn::Mask<Tag> find_normals(const Corners<Tag>& corners_a, const Corners<Tag>& corners_b,
                                      Vector3<Tag>& normals) {
  const Tag d;
  const EdgesAndNormal<Tag> a(corners_a, corners_a[0]), b(corners_b, corners_a[0]);
  const auto size = hn::Max(a.size(), b.size());
  const auto zero = hn::Zero(d);
  const auto least_length = hn::Set(d, least_squared_length);
  LeastPenetration<Tag> best(size);
  hn::Vec<Tag> least, most;
  // The plane of b: a point and the interval of a. Then the plane of a, the same way.
  b.heights(a, least, most);
  best.consider(hn::And(b.has_area, hn::Ge(b.squared_normal, least_length)), b.normal, b.squared_normal,
                hn::Neg(hn::Add(least, most)), hn::Sub(most, least));
  a.heights(b, least, most);
  best.consider(hn::And(a.has_area, hn::Ge(a.squared_normal, least_length)), a.normal, a.squared_normal,
                hn::Add(least, most), hn::Sub(most, least));
  // Along edge_a × edge_b each edge is flat. The third corner of a lies -edge_b · normal_a from edge_a, for
  // all three edges of a, and the third corner of b lies edge_a · normal_b from edge_b.
  hn::Vec<Tag> third_b[3], extent_b[3];
  for (int i = 0; i < 3; ++i) {
    third_b[i] = dot<Tag>(a.edges[i], b.normal);
    extent_b[i] = hn::Abs(third_b[i]);
  }
  for (int j = 0; j < 3; ++j) {
    const auto third_a = hn::Neg(dot<Tag>(b.edges[j], a.normal)), extent_a = hn::Abs(third_a);
    for (int i = 0; i < 3; ++i) {
      const Vector3<Tag> direction = cross<Tag>(a.edges[i], b.edges[j]);
      const auto squared_length = squared_norm<Tag>(direction);
      // Infinite for short edges: their directions count as parallel to all others.
      const auto parallel = hn::Max(hn::Mul(a.parallel[i], b.squared_lengths[j]), least_length);
      const auto is_valid = hn::And(hn::Gt(squared_length, parallel), b.is_long[j]);
      const auto between = dot<Tag>(direction, subtract<Tag>(b.corners[j], a.corners[i]));
      const auto offset = hn::Add(hn::Add(between, between), hn::Sub(third_b[i], third_a));
      best.consider(is_valid, direction, squared_length, offset, hn::Add(extent_a, extent_b[i]));
    }
  }
  normals = best.unit_normal();
  const auto in_range = hn::And(hn::Ge(size, hn::Set(d, least_size)), hn::Le(size, hn::Set(d, most_size)));
  return hn::And(in_range, hn::Gt(best.squared_length, zero));
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
