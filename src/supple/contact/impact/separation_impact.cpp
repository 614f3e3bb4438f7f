// The first time at which moving elements are at a distance of at most d > 0, by integers.
//
// The nearest points of two elements lie on two features: each a vertex, an open edge or an open face whose
// line or plane has its nearest point within. Strict inequalities between polynomials in t tell which
// features these are, and a quotient of polynomials is their squared distance. The times at which the
// distance is at most d are a closed set. The first of them, unless it is 0, is a time at which two features
// reach distance d, and so a root of |distance|² · divisor - d² · divisor, which is not the polynomial 0.
//
// For the distance that elements keep in a safe step, d² can be the sum of a rational number and a square
// root. Squaring removes the root: (|distance|² - rational)² = root², where |distance|² is above the rational
// part.

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contact/impact/exact_impact.hpp"
#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/polynomial.hpp"

namespace supple {
namespace {

/// A vector that is linear in t, or a product of such.
using Path = std::array<Polynomial, 3>;

Polynomial dot(const Path& u, const Path& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}
Path cross(const Path& u, const Path& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// Vertices of the first element, then of the second. A vertex and an edge stand in this order.
struct FeaturePair {
  enum Kind { interiors, vertex_edge, vertices } kind;
  std::array<std::size_t, 3> vertex = {};
};
constexpr auto interiors = FeaturePair::interiors;
constexpr auto vertex_edge = FeaturePair::vertex_edge;
constexpr auto vertices = FeaturePair::vertices;

constexpr std::array<FeaturePair, 7> vertex_face_features = {{{vertices, {0, 1}},
                                                              {vertices, {0, 2}},
                                                              {vertices, {0, 3}},
                                                              {vertex_edge, {0, 1, 2}},
                                                              {vertex_edge, {0, 2, 3}},
                                                              {vertex_edge, {0, 3, 1}},
                                                              {interiors}}};
constexpr std::array<FeaturePair, 9> edge_edge_features = {{{vertices, {0, 2}},
                                                            {vertices, {0, 3}},
                                                            {vertices, {1, 2}},
                                                            {vertices, {1, 3}},
                                                            {vertex_edge, {0, 2, 3}},
                                                            {vertex_edge, {1, 2, 3}},
                                                            {vertex_edge, {2, 0, 1}},
                                                            {vertex_edge, {3, 0, 1}},
                                                            {interiors}}};

/// A squared distance (rational + √squared_root) / divisor.
struct SquaredDistance {
  UnboundedInteger rational = 0, squared_root = 0, divisor = 1;
};

/// The sign of the distance between two features minus a given distance is that of `difference`, where all of
/// `conditions` are positive.
struct FeatureDistance {
  Polynomial difference;
  std::vector<Polynomial> conditions;
};

/// Two moving elements in integer coordinates.
class Elements {
 public:
  Elements(const ElementMotion& motion, double separation) : edges_(motion.are_edges) {
    std::array<double, 25> numbers;
    std::size_t i = 0;
    for (const auto* moment : {&motion.start, &motion.end}) {
      for (const Vec3d& p : *moment) {
        for (int axis = 0; axis < 3; ++axis) numbers[i++] = p[axis];
      }
    }
    numbers[i] = separation;
    const int lowest = BitRange(numbers).lowest;
    const auto integer = [&](std::size_t n) { return to_integer<UnboundedInteger>(numbers[n], lowest); };
    for (std::size_t n = 0; n < 12; ++n) {
      vertices_[n / 3][n % 3] = Polynomial({integer(n), integer(n + 12) - integer(n)});
    }
    separation_ = integer(24);
    u_ = path(edges_ ? 0 : 2, 1);
    v_ = path(2, 3);
    w_ = path(2, 0);
    normal_ = cross(u_, v_);
  }

  std::span<const FeaturePair> features() const {
    if (edges_) return edge_edge_features;
    return vertex_face_features;
  }

  const UnboundedInteger& separation() const { return separation_; }

  /// The squared distance between the lines and planes of two features is a quotient of polynomials. It has
  /// no meaning where the features are not `within` reach.
  std::pair<Polynomial, Polynomial> squared_distance(const FeaturePair& pair) const {
    if (pair.kind == FeaturePair::interiors) {
      const Polynomial volume = dot(normal_, w_);
      return {volume * volume, dot(normal_, normal_)};
    }
    const Path to_vertex = path(pair.vertex[1], pair.vertex[0]);
    if (pair.kind == FeaturePair::vertices) return {dot(to_vertex, to_vertex), Polynomial({1})};
    const Path edge = path(pair.vertex[1], pair.vertex[2]);
    const Path moment = cross(to_vertex, edge);
    return {dot(moment, moment), dot(edge, edge)};
  }

  /// Polynomials all of which are positive where the nearest points of the features' lines and planes exist
  /// and lie within the features.
  std::vector<Polynomial> within(const FeaturePair& pair) const {
    if (pair.kind == FeaturePair::vertices) return {};
    if (pair.kind == FeaturePair::vertex_edge) {
      const Path to_vertex = path(pair.vertex[1], pair.vertex[0]);
      const Path edge = path(pair.vertex[1], pair.vertex[2]);
      Polynomial along = dot(to_vertex, edge);
      Polynomial rest = dot(edge, edge) - along;
      return {std::move(along), std::move(rest)};
    }
    // The foot of the vertex is s u + r v, or the feet of the edges are s u and r v: times |normal|².
    const Polynomial whole = dot(normal_, normal_);
    Polynomial s = dot(edges_ ? cross(v_, w_) : cross(w_, v_), normal_), r = dot(cross(u_, w_), normal_);
    if (edges_) return {s, whole - s, r, whole - r};
    return {s, r, whole - s - r};
  }

 private:
  Path path(std::size_t from, std::size_t to) const {
    Path result;
    for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = vertices_[to][axis] - vertices_[from][axis];
    return result;
  }

  bool edges_;
  std::array<Path, 4> vertices_;
  UnboundedInteger separation_;
  Path u_, v_, w_, normal_;
};

bool all_positive(const std::vector<Polynomial>& conditions, UnitRoot& time) {
  return std::ranges::all_of(conditions, [&](const Polynomial& p) { return time.sign_of(p) > 0; });
}

FeatureDistance compare(const Elements& elements, const FeaturePair& pair, const SquaredDistance& squared) {
  const auto [numerator, denominator] = elements.squared_distance(pair);
  FeatureDistance result{numerator * squared.divisor - denominator * squared.rational, {}};
  if (squared.squared_root == 0) return result;
  result.conditions = {result.difference};
  const Polynomial& rest = result.conditions.front();
  result.difference = rest * rest - denominator * denominator * squared.squared_root;
  return result;
}

/// The first time after the start at which the elements are at this distance. They are farther apart at the
/// start.
std::optional<TimeBracket> first_time(const Elements& elements, const SquaredDistance& squared) {
  std::optional<TimeBracket> first;
  for (const FeaturePair& pair : elements.features()) {
    const FeatureDistance distance = compare(elements, pair, squared);
    if (distance.difference.is_zero()) continue;
    std::vector<UnitRoot> times = roots_in_unit_interval(distance.difference);
    if (times.empty()) continue;
    const std::vector<Polynomial> within = elements.within(pair);
    for (UnitRoot& time : times) {
      if (!all_positive(distance.conditions, time) || !all_positive(within, time)) continue;
      const auto [low, high] = time.neighbouring_doubles();
      first = first ? TimeBracket{std::min(first->low, low), std::min(first->high, high)}
                    : TimeBracket{low, high};
      break;
    }
  }
  return first;
}

UnboundedInteger value_at_start(const Polynomial& p) {
  return p.is_zero() ? UnboundedInteger(0) : p.coefficients().front();
}

/// The squared distance of the elements at the start: that of the nearest features, a quotient of integers.
SquaredDistance squared_distance_at_start(const Elements& elements) {
  UnitRoot start(BinaryFraction{});
  SquaredDistance nearest;
  bool has_nearest = false;
  for (const FeaturePair& pair : elements.features()) {
    if (!all_positive(elements.within(pair), start)) continue;
    const auto [numerator, denominator] = elements.squared_distance(pair);
    const UnboundedInteger p = value_at_start(numerator), q = value_at_start(denominator);
    if (has_nearest && p * nearest.divisor >= nearest.rational * q) continue;
    nearest = {p, 0, q};
    has_nearest = true;
  }
  return nearest;
}

/// D² = p / q at the start, `keep` = k / 2^j and k' = 2^j - k. Elements within the separation s keep k D /
/// 2^j. The others keep (k' s + k D) / 2^j, whose square times 4^j q is k'² s² q + k² p + 2 k k' s √(p q).
SquaredDistance kept_squared_distance(const SquaredDistance& at_start, const UnboundedInteger& s,
                                      double keep) {
  const auto& [p, none, q] = at_start;
  const int lowest = BitRange(std::array{keep}).lowest;
  const UnboundedInteger k = to_integer<UnboundedInteger>(keep, lowest),
                         rest = (UnboundedInteger(1) << -lowest) - k;
  SquaredDistance kept{k * k * p, 0, q << (-2 * lowest)};
  if (p <= s * s * q) return kept;
  kept.rational += rest * rest * s * s * q;
  kept.squared_root = 4 * k * k * rest * rest * s * s * p * q;
  return kept;
}

}  // namespace

std::optional<TimeBracket> exact_first_contact(const ElementMotion& motion, double separation) {
  const Elements elements(motion, separation);
  const SquaredDistance squared{elements.separation() * elements.separation(), 0, 1},
      at_start = squared_distance_at_start(elements);
  if (at_start.rational <= squared.rational * at_start.divisor) return TimeBracket{0, 0};
  return first_time(elements, squared);
}

std::optional<TimeBracket> exact_first_contact(const ElementMotion& motion, const KeptDistance& kept) {
  const Elements elements(motion, kept.separation);
  const SquaredDistance at_start = squared_distance_at_start(elements),
                        squared = kept_squared_distance(at_start, elements.separation(), kept.keep);
  if (at_start.rational == 0) return TimeBracket{0, 0};
  // Elements that may come into contact: the algebra of distances does not cover these.
  if (squared.rational == 0) return exact_first_contact(motion);
  return first_time(elements, squared);
}

}  // namespace supple
