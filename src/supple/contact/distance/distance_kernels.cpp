#include "contact/distance/distance_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/distance/distance_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "contact/distance/double_double-inl.hpp"
#include "geometry/vector3-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Vector point(const PointsBlock& block, std::size_t vertex, std::size_t first) {
  Vector point;
  Doubles unused;
  hn::LoadInterleaved4(Lanes(), block.points[vertex][first], point.x, point.y, point.z, unused);
  return point;
}
HWY_INLINE Vector backwards(const Vector& v) {
  return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
}

// --- classify ---
//
// Operations are not fused, so that every instruction set leaves the same pairs undecided. Let e = 2^-53. A
// sum of products of k factors in which each term takes part in r roundings has an error below
// 1.01 r e times the sum of the magnitudes of its terms.

/// The largest magnitude of a coordinate.
HWY_INLINE Doubles size_of(const Vector& v) {
  const Vector size = absolute(v);
  return hn::Max(size.x, hn::Max(size.y, size.z));
}

constexpr double crosses = static_cast<double>(FeatureCode::crosses);
constexpr double apart = static_cast<double>(FeatureCode::apart);
constexpr double unknown = static_cast<double>(FeatureCode::unknown);

HWY_INLINE void store(Doubles lanes, FeatureCode* codes, std::size_t count) {
  double numbers[8];
  hn::StoreU(lanes, Lanes(), numbers);
  for (std::size_t i = 0; i < std::min(count, hn::Lanes(Lanes())); ++i)
    codes[i] = static_cast<FeatureCode>(numbers[i]);
}

/// One vector of pairs.
class Classification {
 public:
  HWY_INLINE Classification(Doubles reach)
      : squared_reach_(hn::Min(hn::Mul(reach, reach), constant(0x1p220))), code_(constant(unknown)) {}

  /// Decides the pairs whose closest points are inside both elements: all signs are positive.
  ///
  /// With a, b, c the largest coordinates of u, v and w, `along_u` has 12 terms of at most a b² c and 11
  /// roundings, an error below 2^-45 a b² c. In the same way, the error of `along_v` is below 2^-45 a² b c,
  /// that of `whole` below 2^-45 a² b², and that of `volume`, with 6 terms and 8 roundings, below 2^-47 a b
  /// c. Differences of these numbers add their errors and at most 24 e times the magnitudes, which the bounds
  /// contain twice.
  HWY_INLINE void try_interiors(const Vector& u, const Vector& v, const Vector& w, bool are_edges) {
    const Lanes d;
    const Doubles a = size_of(u), b = size_of(v), c = size_of(w), zero = hn::Zero(d);
    const Vector normal = cross(u, v);
    const Doubles volume = dot(normal, w), whole = dot(normal, normal);
    const Doubles along_u = dot(are_edges ? cross(v, w) : cross(w, v), normal);
    const Doubles along_v = dot(cross(u, w), normal);
    const Doubles ab = hn::Mul(a, b), bound = constant(0x1p-45);
    const Doubles error_u = hn::Mul(bound, hn::Mul(ab, hn::Mul(b, c)));
    const Doubles error_v = hn::Mul(bound, hn::Mul(ab, hn::Mul(a, c)));
    const Doubles error_whole = hn::Mul(bound, hn::Mul(ab, ab));
    const Doubles least = hn::Min(a, hn::Min(b, c)), most = hn::Max(a, hn::Max(b, c));
    // No product underflows or overflows. All comparisons with NaN are false.
    const LaneMask in_range = hn::And(hn::Gt(least, constant(0x1p-100)), hn::Lt(most, constant(0x1p100)));
    LaneMask inside = hn::And(hn::Gt(along_u, error_u), hn::Gt(along_v, error_v));
    LaneMask outside = hn::Or(hn::Lt(along_u, hn::Neg(error_u)), hn::Lt(along_v, hn::Neg(error_v)));
    const auto check_rest = [&](Doubles rest, Doubles error) HWY_ATTR {
      inside = hn::And(inside, hn::Gt(rest, error));
      outside = hn::Or(outside, hn::Lt(rest, hn::Neg(error)));
    };
    if (are_edges) {
      check_rest(hn::Sub(whole, along_u), hn::Add(error_whole, error_u));
      check_rest(hn::Sub(whole, along_v), hn::Add(error_whole, error_v));
    } else {
      check_rest(hn::Sub(hn::Sub(whole, along_u), along_v), hn::Add(error_whole, hn::Add(error_u, error_v)));
    }
    is_inside_ = hn::And(inside, in_range);
    is_outside_ = hn::And(outside, in_range);
    // The squared distance is volume² / whole.
    const Doubles squared = hn::Mul(volume, volume), limit = hn::Mul(squared_reach_, whole);
    const Doubles error_volume = hn::Mul(constant(0x1p-47), hn::Mul(ab, c));
    const Doubles twice = hn::Add(hn::Abs(volume), hn::Abs(volume));
    const Doubles error = hn::Add(
        hn::Add(hn::Mul(error_volume, hn::Add(twice, error_volume)), hn::Mul(squared_reach_, error_whole)),
        hn::Mul(constant(0x1p-49), hn::Add(squared, limit)));
    decide(is_inside_, squared, limit, error, zero);
  }
  HWY_INLINE bool is_complete() const { return hn::AllTrue(Lanes(), is_inside_); }

  /// Starts the search on the borders. `size` is a bound of all coordinates of differences.
  HWY_INLINE void start_borders(Doubles size) {
    // The error of a squared distance below, of `along` and of `whole` is less than 2^-45 size².
    size_ = size;
    error_ = hn::Mul(constant(0x1p-42), hn::Mul(size, size));
    is_known_ =
        hn::And(is_outside_, hn::And(hn::Gt(size, constant(0x1p-100)), hn::Lt(size, constant(0x1p100))));
    best_ = constant(0x1p1000);
    best_code_ = constant(unknown);
    nearest_ = {hn::Zero(Lanes()), hn::Zero(Lanes()), hn::Zero(Lanes())};
  }
  /// A vertex against an edge from `low` to `high`. `to_vertex` starts at `low`.
  ///
  /// With s the bound of the coordinates, `along` and `whole` have 3 terms of at most s² and 5 roundings. The
  /// parameter t is the quotient of two such numbers and is near the minimum of a parabola, so its error does
  /// not count. Each coordinate of the difference has an error below 7 e s, and the squared distance one
  /// below 2^-45 s².
  HWY_INLINE void try_vertex_and_edge(const Vector& to_vertex, const Vector& edge, double low, double high,
                                      double inside) {
    const Lanes d;
    const Doubles along = dot(to_vertex, edge), whole = dot(edge, edge), rest = hn::Sub(along, whole);
    const LaneMask at_low = hn::Lt(along, hn::Neg(error_)), at_high = hn::Gt(rest, error_);
    const LaneMask is_inside = hn::And(hn::Gt(along, error_), hn::Lt(rest, hn::Neg(error_)));
    is_known_ = hn::And(is_known_, hn::Or(is_inside, hn::Or(at_low, at_high)));
    const Doubles t =
        hn::IfThenElse(is_inside, hn::Div(along, whole), hn::IfThenElse(at_high, constant(1), hn::Zero(d)));
    const Doubles code =
        hn::IfThenElse(is_inside, constant(inside), hn::IfThenElse(at_high, constant(high), constant(low)));
    const Vector difference = subtract(to_vertex, scaled(edge, t));
    const Doubles squared = dot(difference, difference), gain = hn::Sub(best_, squared);
    const LaneMask is_other = hn::Ne(code, best_code_);
    const LaneMask is_better = hn::And(is_other, hn::Gt(gain, error_));
    const LaneMask is_worse = hn::Lt(gain, hn::Neg(error_));
    is_known_ = hn::And(is_known_, hn::Or(is_better, hn::Or(is_worse, hn::Not(is_other))));
    best_ = hn::IfThenElse(is_better, squared, best_);
    nearest_ = select<Lanes>(is_better, difference, nearest_);
    best_code_ = hn::IfThenElse(is_better, code, best_code_);
  }
  HWY_INLINE void finish_borders() {
    decide(is_known_, best_, squared_reach_, hn::Add(error_, hn::Mul(constant(0x1p-49), squared_reach_)),
           best_code_);
  }
  HWY_INLINE bool has_unknown() const { return !hn::AllFalse(Lanes(), hn::Eq(code_, constant(unknown))); }
  /// Excludes undecided pairs, most of them with parallel edges, whose vertices are on different sides of a
  /// slab. It is normal to the difference of the nearest points on the borders and wider than the distance.
  ///
  /// Each product has 3 terms and 4 roundings, an error below 2^-49 of the product of the sizes.
  template <class... Differences>
  HWY_INLINE void try_slab(Doubles reach, const Differences&... differences) {
    const Doubles size = size_of(nearest_);
    Doubles least = constant(0x1p1000);
    ((least = hn::Min(least, dot(nearest_, differences))), ...);
    const Doubles width = hn::Mul(hn::Mul(reach, hn::Sqrt(dot(nearest_, nearest_))), constant(1 + 0x1p-40));
    const Doubles error = hn::Mul(constant(0x1p-45), hn::Mul(size, size_));
    const LaneMask in_range = hn::And(hn::Gt(size, constant(0x1p-200)), hn::Lt(size_, constant(0x1p100)));
    const LaneMask beyond = hn::And(in_range, hn::Gt(least, hn::Add(width, error)));
    code_ = hn::IfThenElse(hn::And(hn::Eq(code_, constant(unknown)), beyond), constant(apart), code_);
  }
  HWY_INLINE Doubles codes() const { return code_; }

 private:
  /// Sets the codes of the lanes where `value` is certainly at most `limit`, or above it.
  HWY_INLINE void decide(LaneMask lanes, Doubles value, Doubles limit, Doubles error, Doubles code) {
    const LaneMask within = hn::And(lanes, hn::Lt(value, hn::Sub(limit, error)));
    const LaneMask beyond = hn::And(lanes, hn::Gt(value, hn::Add(limit, error)));
    code_ = hn::IfThenElse(within, code, hn::IfThenElse(beyond, constant(apart), code_));
  }

  Doubles squared_reach_, code_;
  LaneMask is_inside_, is_outside_;  // certainly
  Doubles size_, error_, best_, best_code_;
  Vector nearest_;  // difference of the nearest points on the borders, from b to a
  LaneMask is_known_;
};

void Classify(const PointsBlock& block, std::size_t count, bool are_edges, double max_distance,
              FeatureCode* codes) {
  const Lanes d;
  for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
    const Vector p0 = point(block, 0, first), p1 = point(block, 1, first), p2 = point(block, 2, first),
                 p3 = point(block, 3, first);
    const Doubles reach = constant(max_distance);
    Classification pairs(reach);
    if (are_edges) {
      const Vector u = subtract(p1, p0), v = subtract(p3, p2), w = subtract(p0, p2);
      pairs.try_interiors(u, v, w, true);
      if (!pairs.is_complete()) {
        pairs.start_borders(hn::Add(size_of(u), hn::Add(size_of(v), size_of(w))));
        const Vector p1_p2 = subtract(p1, p2), p0_p3 = subtract(p0, p3);
        pairs.try_vertex_and_edge(w, v, 1, 2, 5);
        pairs.try_vertex_and_edge(p1_p2, v, 3, 4, 6);
        pairs.try_vertex_and_edge(w, backwards(u), 1, 3, 7);
        pairs.try_vertex_and_edge(p0_p3, backwards(u), 2, 4, 8);
        pairs.finish_borders();
        if (pairs.has_unknown()) pairs.try_slab(reach, w, p1_p2, p0_p3, subtract(p1, p3));
      }
    } else {
      const Vector u = subtract(p2, p1), v = subtract(p3, p1), w = subtract(p0, p1);
      pairs.try_interiors(u, v, w, false);
      if (!pairs.is_complete()) {
        pairs.start_borders(hn::Add(size_of(u), hn::Add(size_of(v), size_of(w))));
        const Vector p0_p2 = subtract(p0, p2);
        pairs.try_vertex_and_edge(w, u, 1, 2, 4);
        pairs.try_vertex_and_edge(w, v, 1, 3, 5);
        pairs.try_vertex_and_edge(p0_p2, subtract(p3, p2), 2, 3, 6);
        pairs.finish_borders();
        if (pairs.has_unknown()) pairs.try_slab(reach, w, p0_p2, subtract(p0, p3));
      }
    }
    store(pairs.codes(), codes + first, count - first);
  }
}

/// With the points seen from the first end of the edge, an edge w crosses a face a, b, c when the volumes
/// w·(a × b), w·(b × c) and w·(c × a) have one sign, and the ends are on different sides of the face: the
/// first by the volume a·(b × c), the last by that volume less the sum of the others.
///
/// With s the largest coordinate of a, b and c and r that of w, the last side has 6 terms of at most s³, 18
/// of at most r s² and 11 roundings, an error below 2^-44 s² (r + s). The other errors are smaller.
void ClassifyCrossings(const PointsBlock& block, std::size_t count, FeatureCode* codes) {
  for (std::size_t first = 0; first < count; first += hn::Lanes(Lanes())) {
    const Vector p = point(block, 0, first), w = subtract(point(block, 1, first), p),
                 a = subtract(point(block, 2, first), p), b = subtract(point(block, 3, first), p),
                 c = subtract(point(block, 4, first), p), bxc = cross(b, c);
    const Doubles t0 = dot(w, cross(a, b)), t1 = dot(w, bxc), t2 = dot(w, cross(c, a));
    const Doubles from = dot(a, bxc), to = hn::Sub(from, hn::Add(hn::Add(t0, t1), t2));
    const Doubles r = size_of(w), s = hn::Max(size_of(a), hn::Max(size_of(b), size_of(c)));
    const Doubles error = hn::Mul(constant(0x1p-44), hn::Mul(hn::Mul(s, s), hn::Add(r, s)));
    const LaneMask in_range =
        hn::And(hn::Gt(hn::Min(r, s), constant(0x1p-100)), hn::Lt(hn::Max(r, s), constant(0x1p100)));
    const auto same_sign = [&](Doubles least, Doubles most) HWY_ATTR {
      return hn::Or(hn::Gt(least, error), hn::Lt(most, hn::Neg(error)));
    };
    const auto other_sign = [&](Doubles least, Doubles most) HWY_ATTR {
      return hn::And(hn::Lt(least, hn::Neg(error)), hn::Gt(most, error));
    };
    const Doubles least = hn::Min(t0, hn::Min(t1, t2)), most = hn::Max(t0, hn::Max(t1, t2));
    const Doubles least_side = hn::Min(from, to), most_side = hn::Max(from, to);
    const LaneMask misses = hn::Or(other_sign(least, most), same_sign(least_side, most_side));
    const LaneMask meets = hn::And(same_sign(least, most), other_sign(least_side, most_side));
    const Doubles code =
        hn::IfThenElse(misses, constant(apart), hn::IfThenElse(meets, constant(crosses), constant(unknown)));
    store(hn::IfThenElse(in_range, code, constant(unknown)), codes + first, count - first);
  }
}

// --- compute_distance_numbers ---

/// `direction_of` of element_distance.cpp; invalid where the vector is 0 or not finite.
HWY_INLINE Vector direction_of(const Vector& v, LaneMask& is_valid) {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> words;
  const Doubles size = size_of(v);
  is_valid = hn::And(is_valid, hn::And(hn::Gt(size, constant(0x1p-1000)), hn::Lt(size, constant(0x1p1000))));
  // 2^-ilogb(size): the exponent bits 2046 - exponent.
  const auto exponent = hn::And(hn::BitCast(words, size), hn::Set(words, 0x7ff0000000000000u));
  const auto inverse = hn::Sub(hn::Set(words, 0x7fe0000000000000u), exponent);
  const Vector unit = scaled(v, hn::BitCast(d, inverse));
  return scaled(unit, hn::Div(constant(1), hn::Sqrt(dot(unit, unit))));
}

/// Whether a squared length has the range in which pairs of doubles are accurate.
HWY_INLINE LaneMask in_range(Doubles square) {
  return hn::And(hn::Gt(square, constant(0x1p-120)), hn::Lt(square, constant(0x1p120)));
}

// As `rounded_by_integers` of element_distance.cpp, for each kind of features.
//
// Pairs of doubles have a relative error below 2^-96 of the magnitudes of all terms. Lengths are between
// 2^-60 and 2^60 here. With full accuracy, the sines of all angles are above 2^-40, so all results have a
// relative error below 2^-53. With rough accuracy, those at elements that nearly touch are above 2^-68, and
// the error is below 2^-26.

/// One vector of pairs.
struct Part {
  const PointsBlock& block;
  std::size_t first;
  bool is_single;  // all lanes have one pair: what is in other lanes of the block could be slow
  bool is_full;    // accuracy

  HWY_INLINE Vector point(std::size_t vertex) const {
    const double* const p = block.points[vertex][first];
    if (is_single) return {constant(p[0]), constant(p[1]), constant(p[2])};
    return HWY_NAMESPACE::point(block, vertex, first);
  }
};

struct Numbers {
  Pairs squared, divisor;
  PairsVector direction;
  LaneMask is_valid;
};

/// `magnitude` is that of the terms of `squared`.
HWY_INLINE void store(const Numbers& n, Doubles magnitude, const Part& part, DistanceNumbersBlock& numbers) {
  const std::size_t first = part.first;
  const Lanes d;
  const Doubles squared = rounded(n.squared), zero = hn::Zero(d);
  LaneMask is_valid = n.is_valid;
  if (!part.is_full) is_valid = hn::And(is_valid, hn::Gt(squared, hn::Mul(constant(0x1p-136), magnitude)));
  const Vector direction =
      direction_of({rounded(n.direction.x), rounded(n.direction.y), rounded(n.direction.z)}, is_valid);
  hn::Store(hn::Sqrt(hn::Div(squared, rounded(n.divisor))), d, numbers.distance + first);
  hn::Store(direction.x, d, numbers.direction[0] + first);
  hn::Store(direction.y, d, numbers.direction[1] + first);
  hn::Store(direction.z, d, numbers.direction[2] + first);
  hn::Store(hn::IfThenElse(is_valid, constant(1), zero), d, numbers.is_valid + first);
}
HWY_INLINE void store_part(std::size_t i, const Pairs& along, const Pairs& rest, const Pairs& divisor,
                           std::size_t first, DistanceNumbersBlock& numbers) {
  hn::Store(hn::Div(rounded(along), rounded(divisor)), Lanes(), numbers.along[i] + first);
  hn::Store(hn::Div(rounded(rest), rounded(divisor)), Lanes(), numbers.rest[i] + first);
}

void compute_vertices(const Part& part, DistanceNumbersBlock& numbers) {
  const Vector p = part.point(0), q = part.point(1), difference = subtract(p, q);
  const PairsVector direction = exact_difference(p, q);
  const Doubles zero = hn::Zero(Lanes());
  const Pairs none{zero, zero}, one{constant(1), zero};
  for (std::size_t i = 0; i < 2; ++i) store_part(i, none, none, one, part.first, numbers);
  store({dot(direction, direction), one, direction, in_range(dot(difference, difference))}, zero, part,
        numbers);
}

void compute_vertex_edge(const Part& part, DistanceNumbersBlock& numbers) {
  const Vector vertex = part.point(0), low = part.point(1), high = part.point(2);
  const Vector w = subtract(vertex, low), e = subtract(high, low), wxe = cross(w, e);
  const Doubles ww = dot(w, w), ee = dot(e, e), magnitude = hn::Mul(ww, ee), zero = hn::Zero(Lanes());
  LaneMask is_valid = hn::And(in_range(ww), in_range(ee));
  if (part.is_full)
    is_valid = hn::And(is_valid, hn::Gt(dot(wxe, wxe), hn::Mul(constant(0x1p-80), magnitude)));
  const PairsVector to_vertex = exact_difference(vertex, low), edge = exact_difference(high, low);
  const Pairs along = dot(to_vertex, edge), whole = dot(edge, edge), none{zero, zero};
  const PairsVector moment = cross(to_vertex, edge);
  const auto component = [&](const Pairs& of_vertex, const Pairs& of_edge) HWY_ATTR {
    return subtract(multiply(of_vertex, whole), multiply(of_edge, along));
  };
  const PairsVector direction{component(to_vertex.x, edge.x), component(to_vertex.y, edge.y),
                              component(to_vertex.z, edge.z)};
  store_part(0, along, subtract(whole, along), whole, part.first, numbers);
  store_part(1, none, none, whole, part.first, numbers);
  store({dot(moment, moment), whole, direction, is_valid}, magnitude, part, numbers);
}

template <bool are_edges>
void compute_interiors(const Part& part, DistanceNumbersBlock& numbers) {
  const Vector p0 = part.point(0), p1 = part.point(1), p2 = part.point(2), p3 = part.point(3);
  const Vector u = are_edges ? subtract(p1, p0) : subtract(p2, p1);
  const Vector v = are_edges ? subtract(p3, p2) : subtract(p3, p1);
  const Vector w = are_edges ? subtract(p0, p2) : subtract(p0, p1);
  const Vector n = cross(u, v);
  const Doubles uu = dot(u, u), vv = dot(v, v), ww = dot(w, w), plain_volume = dot(n, w);
  const Doubles sizes = hn::Mul(uu, vv), magnitude = hn::Mul(sizes, ww);
  const Doubles squared_sine = part.is_full ? hn::Mul(plain_volume, plain_volume) : dot(n, n);
  const LaneMask is_valid =
      hn::And(hn::And(in_range(uu), hn::And(in_range(vv), in_range(ww))),
              hn::Gt(squared_sine, hn::Mul(constant(0x1p-80), part.is_full ? magnitude : sizes)));
  const PairsVector pu = are_edges ? exact_difference(p1, p0) : exact_difference(p2, p1);
  const PairsVector pv = are_edges ? exact_difference(p3, p2) : exact_difference(p3, p1);
  const PairsVector pw = are_edges ? exact_difference(p0, p2) : exact_difference(p0, p1);
  const PairsVector normal = cross(pu, pv);
  const Pairs volume = dot(normal, pw), whole = dot(normal, normal);
  const Pairs along_u = dot(are_edges ? cross(pv, pw) : cross(pw, pv), normal);
  const Pairs along_v = dot(cross(pu, pw), normal), without_u = subtract(whole, along_u);
  store_part(0, along_u, are_edges ? without_u : subtract(without_u, along_v), whole, part.first, numbers);
  store_part(1, along_v, subtract(whole, along_v), whole, part.first, numbers);
  store({multiply(volume, volume),
         whole,
         {multiply(normal.x, volume), multiply(normal.y, volume), multiply(normal.z, volume)},
         is_valid},
        magnitude, part, numbers);
}

void ComputeDistanceNumbers(const PointsBlock& block, std::size_t count, FeaturePair kind,
                            DistanceAccuracy accuracy, DistanceNumbersBlock& numbers) {
  const auto compute = kind == FeaturePair::vertices      ? compute_vertices
                       : kind == FeaturePair::vertex_edge ? compute_vertex_edge
                       : kind == FeaturePair::vertex_face ? compute_interiors<false>
                                                          : compute_interiors<true>;
  for (std::size_t first = 0; first < count; first += hn::Lanes(Lanes()))
    compute({block, first, count == 1, accuracy == DistanceAccuracy::full}, numbers);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(Classify);
HWY_EXPORT(ClassifyCrossings);
HWY_EXPORT(ComputeDistanceNumbers);

void classify(const PointsBlock& block, std::size_t count, bool are_edges, double max_distance,
              FeatureCode* codes) {
  HWY_DYNAMIC_DISPATCH(Classify)(block, count, are_edges, max_distance, codes);
}

void classify_crossings(const PointsBlock& block, std::size_t count, FeatureCode* codes) {
  HWY_DYNAMIC_DISPATCH(ClassifyCrossings)(block, count, codes);
}

void compute_distance_numbers(const PointsBlock& block, std::size_t count, FeaturePair kind,
                              DistanceAccuracy accuracy, DistanceNumbersBlock& numbers) {
  HWY_DYNAMIC_DISPATCH(ComputeDistanceNumbers)(block, count, kind, accuracy, numbers);
}

}  // namespace supple
#endif
