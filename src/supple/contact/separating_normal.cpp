#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/separating_normal.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "contact/separating_normal.hpp"
#include "core/packed_lanes-inl.hpp"
#include "geometry/vector.hpp"
#include "geometry/vector3-inl.hpp"

#ifndef SUPPLE_CONTACT_SEPARATING_NORMAL_CPP
#define SUPPLE_CONTACT_SEPARATING_NORMAL_CPP
namespace supple {
namespace {

/// Squared sine of an angle below which two edges count as parallel.
constexpr double parallel_squared_sine = 0x1p-40;
/// Squared distance from a plane, relative to the squared size, below which triangles count as coplanar.
constexpr double flat_squared_distance = 0x1p-64;
/// Directions of a smaller squared length have lost bits to underflow.
constexpr double least_squared_length = 0x1p-900;
/// Within this range the tenth power of a size, the largest product below, neither overflows nor vanishes.
constexpr double least_size = 0x1p-80, most_size = 0x1p80;

constexpr std::size_t most_lanes = 8;
static_assert(IntersectingPairs::capacity % most_lanes == 0);

}  // namespace
}  // namespace supple
#endif

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, most_lanes>;
using Doubles = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;
using Vector = Vector3<Tag>;

HWY_INLINE Doubles squared_norm(const Vector& v) {
  return dot<Tag>(v, v);
}
HWY_INLINE Doubles least_of(Doubles p, Doubles q, Doubles r) {
  return hn::Min(hn::Min(p, q), r);
}
HWY_INLINE Doubles most_of(Doubles p, Doubles q, Doubles r) {
  return hn::Max(hn::Max(p, q), r);
}

/// Triangles relative to corner 0 of the first triangle of each pair.
struct Triangles {
  Corners<Tag> corners, edges;  // edge i goes from corner i to the next one
  Doubles squared_lengths[3];
  Mask is_long[3];  // short edges of segments point anywhere
  Vector normal;
  Doubles squared_normal;
  Mask has_area;  // the others count as segments or points

  HWY_INLINE Triangles(const IntersectingPairs& pairs, std::size_t row, std::size_t first,
                       const Vector& origin) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto load = [&](std::size_t axis)
                            HWY_ATTR { return hn::LoadU(Tag(), pairs.row(row + 3 * i + axis) + first); };
      corners[i] = subtract<Tag>({load(0), load(1), load(2)}, origin);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      edges[i] = subtract<Tag>(corners[(i + 1) % 3], corners[i]);
      squared_lengths[i] = squared_norm(edges[i]);
    }
    normal = cross<Tag>(edges[0], edges[1]);
    squared_normal = squared_norm(normal);
    const auto& [s, t, u] = squared_lengths;
    const Doubles least_long = hn::Mul(hn::Set(Tag(), parallel_squared_sine), most_of(s, t, u));
    for (std::size_t i = 0; i < 3; ++i) is_long[i] = hn::Gt(squared_lengths[i], least_long);
    has_area = hn::Gt(squared_normal, hn::Mul(hn::Set(Tag(), parallel_squared_sine),
                                              most_of(hn::Mul(s, t), hn::Mul(t, u), hn::Mul(u, s))));
  }

  HWY_INLINE Doubles size() const {
    const Vector largest = larger<Tag>(larger<Tag>(absolute<Tag>(corners[0]), absolute<Tag>(corners[1])),
                                       absolute<Tag>(corners[2]));
    return most_of(largest.x, largest.y, largest.z);
  }

  /// The lowest and the highest corner of other triangles above the planes of these, in lengths of the
  /// normals.
  HWY_INLINE void heights(const Triangles& other, Doubles& least, Doubles& most) const {
    const auto height = [&](int i) HWY_ATTR {
      return dot<Tag>(normal, subtract<Tag>(other.corners[i], corners[0]));
    };
    const Doubles p = height(0), q = height(1), r = height(2);
    least = least_of(p, q, r);
    most = most_of(p, q, r);
  }
};

/// The best of the directions considered so far. Depths along a direction are multiples of its length.
struct LeastPenetration {
  Doubles flat, squared_depth, squared_length;
  Vector direction;
  Mask is_flat;

  HWY_INLINE explicit LeastPenetration(Doubles size) {
    const Doubles zero = hn::Zero(Tag());
    flat = hn::Mul(hn::Mul(hn::Set(Tag(), flat_squared_distance), size), size);
    squared_depth = hn::Set(Tag(), 1.0);  // over no length: infinitely deep
    squared_length = zero;
    direction = {zero, zero, zero};
    is_flat = hn::Gt(zero, zero);
  }

  /// Triangle a has to move by `forward` along the direction, or by `backward` against it, to be separated.
  HWY_INLINE void consider(Mask is_valid, const Vector& candidate, Doubles squared_candidate, Doubles forward,
                           Doubles backward) {
    const Doubles depth = hn::Max(hn::Min(forward, backward), hn::Zero(Tag()));
    const Doubles most = hn::Max(forward, backward);
    const Doubles squared = hn::Mul(depth, depth);
    const Mask is_less = hn::Lt(hn::Mul(squared, squared_length), hn::Mul(squared_depth, squared_candidate));
    const Mask is_exact = hn::Ge(squared_candidate, hn::Set(Tag(), least_squared_length));
    const Mask is_better = hn::And(hn::And(is_valid, is_exact), hn::And(is_less, hn::Not(is_flat)));
    const Mask makes_flat = hn::Le(hn::Mul(most, most), hn::Mul(flat, squared_candidate));
    const Mask is_forward = hn::Or(hn::Le(forward, backward), makes_flat);
    const Vector opposite{hn::Neg(candidate.x), hn::Neg(candidate.y), hn::Neg(candidate.z)};
    direction = select<Tag>(is_better, select<Tag>(is_forward, candidate, opposite), direction);
    squared_depth = hn::IfThenElse(is_better, squared, squared_depth);
    squared_length = hn::IfThenElse(is_better, squared_candidate, squared_length);
    is_flat = hn::Or(is_flat, hn::And(is_better, makes_flat));
  }
};

/// Writes x, y and z of the normals from `first` on. Returns a bit for each lane that has none: its triangles
/// are too large or too small, or lie on one line.
HWY_INLINE std::uint64_t find_normals_from(const IntersectingPairs& pairs, std::size_t first,
                                           double (*normals)[IntersectingPairs::capacity]) {
  const Vector origin{hn::LoadU(Tag(), pairs.row(0) + first), hn::LoadU(Tag(), pairs.row(1) + first),
                      hn::LoadU(Tag(), pairs.row(2) + first)};
  const Triangles a(pairs, 0, first, origin), b(pairs, 9, first, origin);
  const Doubles size = hn::Max(a.size(), b.size());
  const Doubles zero = hn::Zero(Tag());
  LeastPenetration best(size);
  Doubles least, most;
  b.heights(a, least, most);
  best.consider(b.has_area, b.normal, b.squared_normal, hn::Neg(least), most);
  a.heights(b, least, most);
  best.consider(a.has_area, a.normal, a.squared_normal, most, hn::Neg(least));
  // Along edge_a × edge_b each edge is flat. The third corner of a lies -edge_b · normal_a from edge_a, for
  // all three edges of a, and the third corner of b lies edge_a · normal_b from edge_b.
  for (int j = 0; j < 3; ++j) {
    const Doubles third_a = hn::Neg(dot<Tag>(b.edges[j], a.normal));
    const Doubles above_a = hn::Max(third_a, zero), below_a = hn::Min(third_a, zero);
    for (int i = 0; i < 3; ++i) {
      const Vector direction = cross<Tag>(a.edges[i], b.edges[j]);
      const Doubles squared_length = squared_norm(direction);
      const Doubles squared_product = hn::Mul(a.squared_lengths[i], b.squared_lengths[j]);
      const Mask is_crossing =
          hn::Gt(squared_length, hn::Mul(hn::Set(Tag(), parallel_squared_sine), squared_product));
      const Mask is_valid = hn::And(is_crossing, hn::And(a.is_long[i], b.is_long[j]));
      const Doubles third_b = dot<Tag>(a.edges[i], b.normal);
      const Doubles offset = dot<Tag>(direction, subtract<Tag>(b.corners[j], a.corners[i]));
      best.consider(is_valid, direction, squared_length,
                    hn::Sub(hn::Add(offset, hn::Max(third_b, zero)), below_a),
                    hn::Sub(hn::Sub(above_a, offset), hn::Min(third_b, zero)));
    }
  }
  const Doubles length = hn::Sqrt(best.squared_length);
  hn::StoreU(hn::Div(best.direction.x, length), Tag(), normals[0] + first);
  hn::StoreU(hn::Div(best.direction.y, length), Tag(), normals[1] + first);
  hn::StoreU(hn::Div(best.direction.z, length), Tag(), normals[2] + first);
  const Mask in_range =
      hn::And(hn::Ge(size, hn::Set(Tag(), least_size)), hn::Le(size, hn::Set(Tag(), most_size)));
  const Mask has_normal = hn::And(in_range, hn::Gt(best.squared_length, zero));
  return mask_bits(Tag(), hn::Not(has_normal)) & ((std::uint64_t{1} << hn::Lanes(Tag())) - 1);
}

std::uint64_t find_normals(const IntersectingPairs& pairs, double (*normals)[IntersectingPairs::capacity]) {
  std::uint64_t without = 0;
  for (std::size_t first = 0; first < pairs.size(); first += hn::Lanes(Tag()))
    without |= find_normals_from(pairs, first, normals) << first;
  return without;
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(find_normals);

namespace {

/// A unit vector perpendicular to the longest edge.
Vec3d perpendicular(const TrianglePoints& a, const TrianglePoints& b) {
  Vec3d longest;
  for (const TrianglePoints* const triangle : {&a, &b}) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d edge = (*triangle)[(i + 1) % 3] - (*triangle)[i];
      if (squared_norm(edge) > squared_norm(longest)) longest = edge;
    }
  }
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::fabs(longest[i]) < std::fabs(longest[axis])) axis = i;
  }
  Vec3d unit;
  unit[axis] = 1;
  const Vec3d direction = cross(longest, unit);
  return direction / norm(direction);
}

/// Triangles of any size, or on one line: brings them to a size of about 1 first.
Vec3d special_normal(const TrianglePoints& a, const TrianglePoints& b) {
  double half_extent = 0;
  bool is_point = true;
  for (const TrianglePoints* const triangle : {&a, &b}) {
    for (const Vec3d& p : *triangle) {
      half_extent = std::max(half_extent, largest_magnitude(p * 0.5 - a[0] * 0.5));
      is_point = is_point && p == a[0];
    }
  }
  if (is_point) return {1, 0, 0};
  // Half of the smallest number is 0.
  const int exponent = half_extent > 0 ? -std::ilogb(half_extent) - 1 : 1074;
  IntersectingPairs pair;
  pair.add({scaled(a[0], exponent), scaled(a[1], exponent), scaled(a[2], exponent)},
           {scaled(b[0], exponent), scaled(b[1], exponent), scaled(b[2], exponent)});
  pair.pad(most_lanes);
  double normals[3][IntersectingPairs::capacity];
  if ((HWY_DYNAMIC_DISPATCH(find_normals)(pair, normals) & 1) != 0)
    return perpendicular(pair.a(0), pair.b(0));
  return {normals[0][0], normals[1][0], normals[2][0]};
}

}  // namespace

void IntersectingPairs::add(const TrianglePoints& a, const TrianglePoints& b) {
  for (int i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      values_[3 * i + axis][count_] = a[i][axis];
      values_[9 + 3 * i + axis][count_] = b[i][axis];
    }
  }
  ++count_;
}

void IntersectingPairs::pad(std::size_t step) {
  for (std::size_t i = count_; i % step != 0; ++i) {
    for (double* const row : values_) row[i] = row[count_ - 1];
  }
}

TrianglePoints IntersectingPairs::points(std::size_t first_row, std::size_t pair) const {
  TrianglePoints points;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t row = first_row + 3 * i;
    points[i] = {values_[row][pair], values_[row + 1][pair], values_[row + 2][pair]};
  }
  return points;
}

void separating_normals(IntersectingPairs& pairs, Vec3d* normals) {
  pairs.pad(most_lanes);
  double components[3][IntersectingPairs::capacity];
  const std::uint64_t without = HWY_DYNAMIC_DISPATCH(find_normals)(pairs, components);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    normals[i] = (without >> i & 1) != 0 ? special_normal(pairs.a(i), pairs.b(i))
                                         : Vec3d{components[0][i], components[1][i], components[2][i]};
  }
}

}  // namespace supple
#endif
