// The first contact of moving elements by algebra.
//
// Two elements are as near as their features: two of {vertex, open edge, open face}, one of each element,
// whose lines and planes have their nearest points within both. Which ones have them is told by strict
// inequalities between polynomials in t, and their squared distance by a quotient of polynomials. All times
// at which the distance is at most d are a closed set. At its first moment, unless that is 0, some features
// are at distance d that were farther apart just before, so it is a root of their
// |distance|² · divisor - d² · divisor, which is not the polynomial 0.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contact/fixed_point_rejection.hpp"
#include "core/error.hpp"
#include "geometry/integer_points.hpp"
#include "geometry/polynomial.hpp"
#include "supple/continuous.hpp"

namespace supple {
namespace {

MotionNumbers numbers_of(const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end,
                         double min_separation) {
  MotionNumbers numbers;
  std::size_t i = 0;
  for (const auto* moment : {&start, &end}) {
    for (const Vec3d& p : *moment) {
      for (int axis = 0; axis < 3; ++axis) numbers[i++] = p[axis];
    }
  }
  numbers[i] = min_separation;
  return numbers;
}

bool is_finite(double value) {
  return Dyadic(value).exponent + 1075 < 0x7ff;
}

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
  Elements(const MotionNumbers& numbers, bool edges) : edges_(edges) {
    const int lowest = BitRange(numbers).lowest;
    for (std::size_t vertex = 0; vertex < 4; ++vertex) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto start = to_integer<UnboundedInteger>(numbers[3 * vertex + axis], lowest);
        const auto end = to_integer<UnboundedInteger>(numbers[12 + 3 * vertex + axis], lowest);
        vertices_[vertex][axis] = Polynomial({start, end - start});
      }
    }
    const auto separation = to_integer<UnboundedInteger>(numbers[24], lowest);
    squared_separation_ = separation * separation;
    u_ = path(edges ? 0 : 2, 1);
    v_ = path(2, 3);
    w_ = path(2, 0);
    normal_ = cross(u_, v_);
    volume_ = dot(normal_, w_);
  }

  bool touching_only() const { return squared_separation_.is_zero(); }

  std::span<const FeaturePair> features() const {
    if (edges_) return edge_edge_features;
    return vertex_face_features;
  }

  /// A multiple of the four vertices' determinant.
  const Polynomial& volume() const { return volume_; }

  /// Positive, 0 or negative as the distance of the lines and planes of two features is above, equal to or
  /// below the separation; 0 is told by 0 alone if the separation is 0. Without a meaning where the features
  /// are not `within` reach.
  Polynomial distance(const FeaturePair& pair) const {
    if (pair.kind == FeaturePair::interiors) {
      if (touching_only()) return volume_;
      return volume_ * volume_ - dot(normal_, normal_) * squared_separation_;
    }
    const Path to_vertex = path(pair.vertex[1], pair.vertex[0]);
    if (pair.kind == FeaturePair::vertices) {
      if (touching_only()) return common_roots(to_vertex);
      return dot(to_vertex, to_vertex) - Polynomial({squared_separation_});
    }
    const Path edge = path(pair.vertex[1], pair.vertex[2]);
    const Path moment = cross(to_vertex, edge);
    if (touching_only()) return common_roots(moment);
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

  static Polynomial common_roots(const Path& path) { return gcd(gcd(path[0], path[1]), path[2]); }

  bool edges_;
  std::array<Path, 4> vertices_;
  UnboundedInteger squared_separation_;
  Path u_, v_, w_, normal_;
  Polynomial volume_;
};

bool all_positive(const std::vector<Polynomial>& conditions, UnitRoot& time) {
  return std::ranges::all_of(conditions, [&](const Polynomial& p) { return time.sign_of(p) > 0; });
}

TimeBracket bracket(UnitRoot& time) {
  const auto [low, high] = time.neighbouring_doubles();
  return {low, high};
}

/// At a time when the four vertices are in one plane.
bool coplanar_elements_touch(const Elements& elements, UnitRoot& time) {
  int lowest_sign = 1;
  for (const Polynomial& p : elements.within({interiors})) {
    lowest_sign = std::min(lowest_sign, time.sign_of(p));
    if (lowest_sign < 0) return false;  // And the element has a normal, or this were 0.
  }
  if (lowest_sign > 0) return true;
  return std::ranges::any_of(elements.features(), [&](const FeaturePair& pair) {
    return pair.kind != interiors && time.sign_of(elements.distance(pair)) == 0 &&
           all_positive(elements.within(pair), time);
  });
}

std::optional<TimeBracket> first_coplanar_contact(const Elements& elements) {
  for (UnitRoot& time : roots_in_unit_interval(elements.volume())) {
    if (coplanar_elements_touch(elements, time)) return bracket(time);
  }
  return std::nullopt;
}

std::optional<TimeBracket> first_contact_of_features(const Elements& elements) {
  const std::span<const FeaturePair> features = elements.features();
  std::vector<Polynomial> distances;
  UnitRoot start(BinaryFraction{});
  for (const FeaturePair& pair : features) {
    distances.push_back(elements.distance(pair));
    const int sign = start.sign_of(distances.back());
    const bool near = elements.touching_only() ? sign == 0 : sign <= 0;
    if (near && all_positive(elements.within(pair), start)) return TimeBracket{0, 0};
  }
  std::optional<TimeBracket> first;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (distances[i].is_zero()) continue;
    std::vector<UnitRoot> times = roots_in_unit_interval(distances[i]);
    if (times.empty()) continue;
    const std::vector<Polynomial> within = elements.within(features[i]);
    for (UnitRoot& time : times) {
      if (!all_positive(within, time)) continue;
      const TimeBracket found = bracket(time);
      first = first ? TimeBracket{std::min(first->low, found.low), std::min(first->high, found.high)} : found;
      break;
    }
  }
  return first;
}

std::optional<TimeBracket> first_contact(const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end,
                                         std::size_t first_size, double min_separation) {
  if (!is_finite(min_separation) || min_separation < 0) {
    fail("min_separation is " + std::to_string(min_separation) +
         "; give a finite number that is not negative");
  }
  const MotionNumbers numbers = numbers_of(start, end, min_separation);
  if (!std::ranges::all_of(numbers, is_finite)) return std::nullopt;
  if (stay_apart_in_fixed_point(numbers, first_size)) return std::nullopt;
  const Elements elements(numbers, first_size == 2);
  const bool cubic_tells = elements.touching_only() && !elements.volume().is_zero();
  return cubic_tells ? first_coplanar_contact(elements) : first_contact_of_features(elements);
}

}  // namespace

std::optional<TimeBracket> first_contact_by_algebra(const VertexFaceMotion& motion, double min_separation) {
  return first_contact(motion.start, motion.end, 1, min_separation);
}

std::optional<TimeBracket> first_contact_by_algebra(const EdgeEdgeMotion& motion, double min_separation) {
  return first_contact(motion.start, motion.end, 2, min_separation);
}

}  // namespace supple
