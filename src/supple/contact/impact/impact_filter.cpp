#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/impact/impact_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <type_traits>

#include "contact/impact/impact_filter.hpp"
#include "core/packed_lanes-inl.hpp"
#include "geometry/vector3-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// At most sixteen lanes, so that their mask is two bytes.
using Lanes = hn::CappedTag<float, 16>;
using Floats = hn::Vec<Lanes>;
using LaneMask = hn::Mask<Lanes>;
using Vector = Vector3<Lanes>;

HWY_INLINE Vector load(const RelativeMotionBlock& block, std::size_t row, std::size_t first) {
  Vector vector;
  Floats unused;
  hn::LoadInterleaved4(Lanes(), block.rows[row][first], vector.x, vector.y, vector.z, unused);
  return vector;
}
/// a b + c and c - a b with two roundings, which all instruction sets have. So the same pairs are undecided
/// on every machine, which is visible where these are reported.
HWY_INLINE Floats sum_with_product(Floats a, Floats b, Floats c) {
  return hn::Add(hn::Mul(a, b), c);
}
HWY_INLINE Floats less_product(Floats a, Floats b, Floats c) {
  return hn::Sub(c, hn::Mul(a, b));
}
HWY_INLINE Floats dot_product(const Vector& a, const Vector& b) {
  return sum_with_product(a.z, b.z, sum_with_product(a.y, b.y, hn::Mul(a.x, b.x)));
}
HWY_INLINE Vector cross_product(const Vector& a, const Vector& b) {
  return {less_product(a.z, b.y, hn::Mul(a.y, b.z)), less_product(a.x, b.z, hn::Mul(a.z, b.x)),
          less_product(a.y, b.x, hn::Mul(a.x, b.y))};
}
HWY_INLINE Floats sum(const Vector& a) {
  return hn::Add(hn::Add(a.x, a.y), a.z);
}

struct Places {
  Vector m, u, w;
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
  HWY_NOINLINE LaneMask separated_along(const Vector& n) const {
    const Lanes d;
    const Floats size = sum(absolute(n));
    const Floats tiny = hn::Set(d, 0x1p-110f);
    Floats bound = sum_with_product(hn::Set(d, 0x1p-20f), dot_product(absolute(n), reach_),
                                    sum_with_product(tiny, size, tiny));
    // The addend covers squares that underflow.
    const Floats length =
        hn::Mul(hn::Sqrt(hn::Add(dot_product(n, n), hn::Set(d, 0x1p-100f))), hn::Set(d, 1 + 0x1p-20f));
    bound = sum_with_product(separation_, length, bound);
    const Floats sm0 = dot_product(n, start_.m), sm1 = dot_product(n, end_.m);
    const Floats su0 = dot_product(n, start_.u), su1 = dot_product(n, end_.u);
    const Floats sw0 = dot_product(n, start_.w), sw1 = dot_product(n, end_.w);
    const Floats above = hn::Min(hn::Sub(sm0, extent(su0, sw0)), hn::Sub(sm1, extent(su1, sw1)));
    const Floats below = hn::Max(hn::Add(sm0, extent(hn::Neg(su0), hn::Neg(sw0))),
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
    const Floats third = hn::Set(d, 1.0f / 3.0f), half = hn::Set(d, 0.5f);
    const Vector n0 = cross_product(start_.u, start_.w), n2 = cross_product(end_.u, end_.w);
    const Vector twice_n1 = add(cross_product(start_.u, end_.w), cross_product(end_.u, start_.w));
    const Floats c0 = dot_product(start_.m, n0), c3 = dot_product(end_.m, n2);
    const Floats c1 = hn::Mul(third, hn::Add(dot_product(end_.m, n0), dot_product(start_.m, twice_n1)));
    const Floats c2 = hn::Mul(third, hn::Add(dot_product(start_.m, n2), dot_product(end_.m, twice_n1)));
    const Floats least = hn::Min(hn::Min(c0, c1), hn::Min(c2, c3));
    const Floats most = hn::Max(hn::Max(c0, c1), hn::Max(c2, c3));
    const Vector minors{sum_with_product(reach_u_.y, reach_w_.z, hn::Mul(reach_u_.z, reach_w_.y)),
                        sum_with_product(reach_u_.z, reach_w_.x, hn::Mul(reach_u_.x, reach_w_.z)),
                        sum_with_product(reach_u_.x, reach_w_.y, hn::Mul(reach_u_.y, reach_w_.x))};
    const Floats tiny = hn::Set(d, 0x1p-100f);
    const Floats magnitude = hn::Mul(hn::Set(d, 8.0f), dot_product(minors, reach_m_));
    Floats bound =
        sum_with_product(hn::Set(d, 0x1p-22f), magnitude, sum_with_product(tiny, sum(reach_), tiny));
    const Floats area =
        hn::Max(sum(absolute(n0)), hn::Max(sum(absolute(n2)), hn::Mul(half, sum(absolute(twice_n1)))));
    bound = sum_with_product(separation_,
                             sum_with_product(hn::Set(d, 0x1p-19f), sum(minors), hn::Add(area, tiny)), bound);
    return hn::Gt(hn::Max(least, hn::Neg(most)), bound);
  }

  /// Other directions reject fewer pairs than they cost: the normals at the start, at the end and between.
  HWY_INLINE LaneMask apart() const {
    const Lanes d;
    const Vector m = add(start_.m, end_.m), u = add(start_.u, end_.u), w = add(start_.w, end_.w);
    const Vector velocity = subtract(end_.m, start_.m);
    LaneMask result = never_coplanar();
    result = hn::Or(result, separated_along(cross_product(velocity, u)));
    result = hn::Or(result, separated_along(cross_product(velocity, w)));
    if (hn::AllTrue(d, result)) return result;
    result = hn::Or(result, separated_along(m));
    result =
        hn::Or(result, separated_along(subtract(scaled(m, dot_product(u, u)), scaled(u, dot_product(m, u)))));
    result =
        hn::Or(result, separated_along(subtract(scaled(m, dot_product(w, w)), scaled(w, dot_product(m, w)))));
    if (is_square_) return result;
    return hn::Or(result, separated_along(cross_product(subtract(w, u), cross_product(u, w))));
  }

 private:
  /// The greatest value of alpha su + beta sw over the domain.
  HWY_INLINE Floats extent(Floats su, Floats sw) const {
    const Floats zero = hn::Zero(Lanes());
    const Floats positive_u = hn::Max(su, zero), positive_w = hn::Max(sw, zero);
    return is_square_ ? hn::Add(positive_u, positive_w) : hn::Max(positive_u, positive_w);
  }

  bool is_square_;
  Floats separation_;
  Places start_, end_;
  Vector reach_m_, reach_u_, reach_w_, reach_;  // greatest magnitudes in the step, by axis
};

// The four scalars from a vertex on, in as few registers as possible.
using FourDoubles = hn::CappedTag<double, 4>;
template <class Scalar>
using Four = hn::Rebind<Scalar, FourDoubles>;

template <class Scalar>
HWY_INLINE hn::Vec<FourDoubles> to_double(hn::Vec<Four<Scalar>> v) {
  if constexpr (std::is_same_v<Scalar, float>) {
    return hn::PromoteTo(FourDoubles(), v);
  } else {
    return v;
  }
}
template <class Scalar>
HWY_INLINE hn::Vec<Four<float>> to_float(hn::Vec<Four<Scalar>> v) {
  if constexpr (std::is_same_v<Scalar, float>) {
    return v;
  } else {
    return hn::DemoteTo(Four<float>(), v);
  }
}

/// One vertex of a pair.
template <class Scalar>
struct PathEnds {
  const Scalar *start, *end;
};

/// Sets one vector of a pair: the difference p - q from time 0 to `latest`.
template <class Scalar>
HWY_INLINE void set_difference(PathEnds<Scalar> p, PathEnds<Scalar> q, float latest, float* start,
                               float* end) {
  const Four<Scalar> d;
  const Four<float> floats;
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    const auto at_start = hn::Sub(hn::LoadU(d, p.start + i), hn::LoadU(d, q.start + i));
    const auto at_end = hn::Sub(hn::LoadU(d, p.end + i), hn::LoadU(d, q.end + i));
    hn::StoreU(to_float<Scalar>(at_start), floats, start + i);
    if (latest < 1) {
      const FourDoubles doubles;
      const auto from_start = hn::Mul(hn::Set(doubles, 1 - double{latest}), to_double<Scalar>(at_start));
      const auto from_end = hn::Mul(hn::Set(doubles, double{latest}), to_double<Scalar>(at_end));
      hn::StoreU(hn::DemoteTo(floats, hn::Add(from_start, from_end)), floats, end + i);
    } else {
      hn::StoreU(to_float<Scalar>(at_end), floats, end + i);
    }
  }
}

template <class Scalar>
HWY_INLINE void set_all_motions(const std::array<VertexPaths<Scalar>, 4>& paths,
                                const std::array<std::uint32_t, 4>* vertices, std::size_t count,
                                bool are_edges, float latest, RelativeMotionBlock& block) {
  using Row = RelativeMotionBlock;
  const auto set = [&](std::size_t row, std::size_t k, std::size_t p, std::size_t q) HWY_ATTR {
    const auto ends = [&](std::size_t i) HWY_ATTR {
      return PathEnds<Scalar>{paths[i].start[vertices[k][i]], paths[i].end[vertices[k][i]]};
    };
    set_difference(ends(p), ends(q), latest, block.rows[row][k], block.rows[Row::end + row][k]);
  };
  // As `relative_vertex_face` and `relative_edge_edge`.
  for (std::size_t k = 0; k < count; ++k) {
    set(Row::m, k, 0, are_edges ? 2 : 1);
    set(Row::u, k, are_edges ? 0 : 2, 1);
    set(Row::w, k, 3, are_edges ? 2 : 1);
  }
}

void FloatMotions(const std::array<VertexPaths<float>, 4>& paths,
                  const std::array<std::uint32_t, 4>* vertices, std::size_t count, bool are_edges,
                  float latest, RelativeMotionBlock& block) {
  set_all_motions(paths, vertices, count, are_edges, latest, block);
}

void DoubleMotions(const std::array<VertexPaths<double>, 4>& paths,
                   const std::array<std::uint32_t, 4>* vertices, std::size_t count, bool are_edges,
                   float latest, RelativeMotionBlock& block) {
  set_all_motions(paths, vertices, count, are_edges, latest, block);
}

std::uint64_t MayTouch(const RelativeMotionBlock& block, std::size_t count, bool is_square,
                       float separation) {
  const Lanes d;
  std::uint64_t apart = 0;
  for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
    apart |= mask_bits(d, Group(block, first, is_square, separation).apart()) << first;
  }
  return ~apart & (count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0});
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(MayTouch);
HWY_EXPORT(FloatMotions);
HWY_EXPORT(DoubleMotions);

std::uint64_t may_touch(const RelativeMotionBlock& block, std::size_t count, bool is_square,
                        float separation) {
  return HWY_DYNAMIC_DISPATCH(MayTouch)(block, count, is_square, separation);
}

void set_motions(const std::array<VertexPaths<float>, 4>& paths, const std::array<std::uint32_t, 4>* vertices,
                 std::size_t count, bool are_edges, float latest, RelativeMotionBlock& block) {
  HWY_DYNAMIC_DISPATCH(FloatMotions)(paths, vertices, count, are_edges, latest, block);
}

void set_motions(const std::array<VertexPaths<double>, 4>& paths,
                 const std::array<std::uint32_t, 4>* vertices, std::size_t count, bool are_edges,
                 float latest, RelativeMotionBlock& block) {
  HWY_DYNAMIC_DISPATCH(DoubleMotions)(paths, vertices, count, are_edges, latest, block);
}

void RelativeMotionBlock::set(std::size_t pair, const RelativeMotion& motion) {
  const auto set_places = [&](std::size_t first_row, const RelativePlaces<double>& places) {
    std::size_t row = first_row;
    for (const Vec3d& v : {places.m, places.u, places.w}) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        rows[row][pair][axis] = static_cast<float>(v[static_cast<int>(axis)]);
      ++row;
    }
  };
  set_places(0, motion.start);
  set_places(end, motion.end);
}

}  // namespace supple
#endif
