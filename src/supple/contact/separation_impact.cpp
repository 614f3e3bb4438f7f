// The first time at which moving elements are at a distance of at most d > 0, by integers.
//
// The nearest points of two elements lie on two features: each a vertex, an open edge or an open face whose
// line or plane has its nearest point within. Strict inequalities between polynomials in t tell which
// features these are, and a quotient of polynomials is their squared distance. The times at which the
// distance is at most d are a closed set. The first of them, unless it is 0, is a time at which two features
// reach distance d, and so a root of |distance|² · divisor - d² · divisor, which is not the polynomial 0.

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "contact/exact_impact.hpp"
#include "geometry/integer_points.hpp"
#include "geometry/polynomial.hpp"

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
    squared_separation_ = integer(24) * integer(24);
    u_ = path(edges_ ? 0 : 2, 1);
    v_ = path(2, 3);
    w_ = path(2, 0);
    normal_ = cross(u_, v_);
  }

  std::span<const FeaturePair> features() const {
    if (edges_) return edge_edge_features;
    return vertex_face_features;
  }

  /// The sign of the distance between the lines and planes of two features minus the separation. Has no
  /// meaning where the features are not `within` reach.
  Polynomial distance(const FeaturePair& pair) const {
    if (pair.kind == FeaturePair::interiors) {
      const Polynomial volume = dot(normal_, w_);
      return volume * volume - dot(normal_, normal_) * squared_separation_;
    }
    const Path to_vertex = path(pair.vertex[1], pair.vertex[0]);
    if (pair.kind == FeaturePair::vertices) {
      return dot(to_vertex, to_vertex) - Polynomial({squared_separation_});
    }
    const Path edge = path(pair.vertex[1], pair.vertex[2]);
    const Path moment = cross(to_vertex, edge);
    return dot(moment, moment) - dot(edge, edge) * squared_separation_;
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
  UnboundedInteger squared_separation_;
  Path u_, v_, w_, normal_;
};

bool all_positive(const std::vector<Polynomial>& conditions, UnitRoot& time) {
  return std::ranges::all_of(conditions, [&](const Polynomial& p) { return time.sign_of(p) > 0; });
}

}  // namespace

std::optional<TimeBracket> exact_first_contact(const ElementMotion& motion, double separation) {
  const Elements elements(motion, separation);
  const std::span<const FeaturePair> features = elements.features();
  std::vector<Polynomial> distances;
  UnitRoot start(BinaryFraction{});
  for (const FeaturePair& pair : features) {
    distances.push_back(elements.distance(pair));
    if (start.sign_of(distances.back()) <= 0 && all_positive(elements.within(pair), start)) {
      return TimeBracket{0, 0};
    }
  }
  std::optional<TimeBracket> first;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (distances[i].is_zero()) continue;
    std::vector<UnitRoot> times = roots_in_unit_interval(distances[i]);
    if (times.empty()) continue;
    const std::vector<Polynomial> within = elements.within(features[i]);
    for (UnitRoot& time : times) {
      if (!all_positive(within, time)) continue;
      const auto [low, high] = time.neighbouring_doubles();
      first = first ? TimeBracket{std::min(first->low, low), std::min(first->high, high)}
                    : TimeBracket{low, high};
      break;
    }
  }
  return first;
}

}  // namespace supple
