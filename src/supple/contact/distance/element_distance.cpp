// The closest points of two elements lie inside both, or on the border of one of them. Signs of polynomials
// in the coordinates decide the first. Otherwise the closest of all pairs of a vertex and an edge counts,
// which a comparison of fractions finds. The same code runs on two kinds of numbers to find the features: on
// doubles with error bounds, and where these cannot decide on integers. A kernel with pairs of doubles, or
// integers again, compute the distance, the weights and the direction.

#include "contact/distance/element_distance.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "contact/distance/distance_kernels.hpp"
#include "contact/distance/element_numbers.hpp"
#include "core/error.hpp"
#include "geometry/numbers/quotient.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

using Features = ClosestFeatures;

/// Which features count where several hold the closest points: the smallest.
auto rank_of(const Features& f, std::uint8_t count_a) {
  const bool is_vertex_of_a = f.vertex < count_a, are_vertices = f.kind == Features::Kind::vertices;
  const std::uint8_t of_a = is_vertex_of_a ? f.vertex : f.edge[1],
                     of_b = is_vertex_of_a ? f.edge[1] : f.vertex;
  return are_vertices ? std::tuple(0, f.vertex, f.edge[0], std::uint8_t{0})
                      : std::tuple(is_vertex_of_a ? 1 : 2, of_a, of_b, f.edge[0]);
}

template <class Numbers>
class FeatureSearch {
 public:
  using Number = typename Numbers::Number;

  FeatureSearch(const Numbers& numbers, const ElementPoints& elements)
      : numbers_(numbers), count_a_(elements.count_a), count_b_(elements.count_b) {}

  /// Returns nothing when a sign is not known.
  std::optional<Features> search() {
    if (count_a_ + count_b_ == 4 && are_interiors_closest()) return known(best_);
    if (count_a_ + count_b_ == 2) {
      consider_vertices(0, 1);
    } else if (count_b_ == 2) {
      const auto first_b = count_a_;
      for (std::uint8_t p = 0; p < count_a_; ++p) consider_vertex_and_edge(p, {first_b, next(first_b)});
      for (std::uint8_t p = first_b; count_a_ == 2 && p < 4; ++p) consider_vertex_and_edge(p, {0, 1});
    } else {
      for (const std::array<std::uint8_t, 2>& edge : {std::array<std::uint8_t, 2>{1, 2}, {1, 3}, {2, 3}})
        consider_vertex_and_edge(0, edge);
    }
    return known(best_);
  }
  /// The sign of the difference of this distance and another one, whose numbers are multiplied by 2^`scale`
  /// with respect to these; nothing when it is not known.
  std::optional<int> compare(const FeatureSearch& other, int scale) {
    Number here = squared_ * other.divisor_, there = other.squared_ * divisor_;
    if constexpr (requires { here <<= 1; }) {
      if (scale > 0) here <<= 2 * scale;
      if (scale < 0) there <<= -2 * scale;
    }
    const int side = sign_of(here - there);
    return known(side);
  }
  /// Whether the distance is at most `most`; nothing when this is not known.
  std::optional<bool> is_within(double most) {
    if (std::isinf(most)) return true;
    const Number length = numbers_.number(most);
    const int side = sign_of(squared_ - length * length * divisor_);
    return known(side <= 0);
  }

 private:
  static std::uint8_t next(std::uint8_t index) { return static_cast<std::uint8_t>(index + 1); }
  template <class Result>
  std::optional<Result> known(const Result& result) const {
    return is_known_ ? std::optional(result) : std::nullopt;
  }
  int sign_of(const Number& number) {
    const int result = Numbers::sign_of(number);
    is_known_ = is_known_ && result != unknown_sign;
    return result;
  }

  bool are_interiors_closest() {
    const bool are_edges = count_a_ == 2;
    const InteriorNumbers<Number> n(numbers_, are_edges);
    const std::array<int, 4> signs{
        Numbers::sign_of(n.along_u), Numbers::sign_of(n.along_v),
        Numbers::sign_of(are_edges ? n.whole - n.along_u : n.whole - n.along_u - n.along_v),
        are_edges ? Numbers::sign_of(n.whole - n.along_v) : 1};
    if (std::ranges::any_of(signs, [](int sign) { return sign <= 0; })) return false;
    is_known_ = std::ranges::count(signs, unknown_sign) == 0;
    best_ = {};
    squared_ = n.volume * n.volume;
    divisor_ = n.whole;
    return true;
  }

  void consider_vertices(std::uint8_t p, std::uint8_t q) {
    const Vector<Number> difference = numbers_.difference(p, q);
    const bool in_order = p < q;
    consider({Features::Kind::vertices, in_order ? p : q, {in_order ? q : p, 0}}, dot(difference, difference),
             numbers_.one());
  }
  void consider_vertex_and_edge(std::uint8_t vertex, const std::array<std::uint8_t, 2>& ends) {
    const VertexEdgeNumbers<Number> n(numbers_, vertex, ends);
    if (sign_of(n.along) <= 0) return consider_vertices(vertex, ends[0]);
    if (sign_of(n.along - n.whole) != -1) return consider_vertices(vertex, ends[1]);
    consider({Features::Kind::vertex_edge, vertex, ends}, n.squared_moment(), n.whole);
  }
  void consider(const Features& features, const Number& squared, const Number& divisor) {
    if (has_best_ && features == best_) return;
    const int order = has_best_ ? sign_of(squared * divisor_ - squared_ * divisor) : -1;
    const bool is_better =
        order < 0 || (order == 0 && rank_of(features, count_a_) < rank_of(best_, count_a_));
    if (!is_better) return;
    has_best_ = true;
    best_ = features;
    squared_ = squared;
    divisor_ = divisor;
  }

  const Numbers& numbers_;
  std::uint8_t count_a_, count_b_;
  Features best_;
  Number squared_{}, divisor_{};  ///< the squared distance is their quotient
  bool has_best_ = false, is_known_ = true;
};

Vec3d direction_of(const Vec3d& v) {
  const double size = largest_magnitude(v);
  if (!(size > 0)) return {};
  const Vec3d unit = std::ldexp(1.0, -std::ilogb(size)) * v;
  return (1 / std::sqrt(supple::dot(unit, unit))) * unit;
}

Vec3d rounded_direction(const Vector<UnboundedInteger>& v) {
  int bits = 0;
  for (const UnboundedInteger& x : v)
    bits = std::max(bits, bit_length(sign(x) < 0 ? UnboundedInteger(-x) : x));
  return direction_of({approximate(v[0], -bits), approximate(v[1], -bits), approximate(v[2], -bits)});
}

/// A direction across elements that touch.
Vec3d direction_across(const IntegerNumbers& numbers, const ElementPoints& elements) {
  const int vertices = elements.count_a + elements.count_b;
  if (vertices == 2) return {1, 0, 0};
  if (vertices == 4) {
    const Vec3d normal =
        rounded_direction(InteriorNumbers<UnboundedInteger>(numbers, elements.count_a == 2).normal);
    if (normal != Vec3d{}) return normal;
  }
  // An edge that is not a point, if there is one. The longest edge of a triangle without area is not needed:
  // all of its edges lie on one line.
  for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(vertices); ++i) {
    if (elements.count_a != i + 1) {
      const Vec3d e = rounded_direction(numbers.difference(i + 1, i));
      if (e != Vec3d{}) return direction_of(supple::cross(e, shortest_axis(e)));
    }
  }
  return {1, 0, 0};
}

/// The squared distance is `squared` / `divisor`, the weights are `along[i]` / `divisor`.
DistanceNumbers rounded_by_integers(const IntegerNumbers& numbers, const ElementPoints& elements,
                                    const Features& features) {
  UnboundedInteger squared, divisor = 1;
  std::array<UnboundedInteger, 2> along{}, rest{};
  Vector<UnboundedInteger> direction;
  if (features.kind == Features::Kind::interiors) {
    const bool are_edges = elements.count_a == 2;
    const InteriorNumbers<UnboundedInteger> n(numbers, are_edges);
    squared = n.volume * n.volume;
    divisor = n.whole;
    along = {n.along_u, n.along_v};
    rest = {n.whole - n.along_u, n.whole - n.along_v};
    if (!are_edges) rest[0] -= n.along_v;
    for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = n.normal[axis] * n.volume;
  } else if (features.kind == Features::Kind::vertex_edge) {
    const VertexEdgeNumbers<UnboundedInteger> n(numbers, features.vertex, features.edge);
    squared = n.squared_moment();
    divisor = n.whole;
    along[0] = n.along;
    rest[0] = n.whole - n.along;
    for (std::size_t axis = 0; axis < 3; ++axis)
      direction[axis] = n.to_vertex[axis] * n.whole - n.edge[axis] * n.along;
  } else {
    direction = numbers.difference(features.vertex, features.edge[0]);
    squared = dot(direction, direction);
  }
  DistanceNumbers result;
  result.distance = Quotient(squared, divisor).square_root(numbers.lowest());
  for (std::size_t i = 0; i < 2; ++i) {
    result.along[i] = Quotient(along[i], divisor).value();
    result.rest[i] = Quotient(rest[i], divisor).value();
  }
  result.direction = rounded_direction(direction);
  return result;
}

/// The feature of a triangle's edge, or of an edge, by the ends' indices in the element.
Feature edge_feature(std::uint8_t first, std::uint8_t last) {
  return {FeatureKind::edge, static_cast<std::uint8_t>(first == 0 && last == 2 ? 2 : first)};
}

std::optional<ElementDistance> checked(const ElementPoints& elements, double max_distance) {
  if (!(max_distance >= 0))
    fail("distance: max_distance is " + std::to_string(max_distance) + "; it must be 0 or more");
  if (!std::ranges::all_of(elements.points, is_finite)) return {};
  bool used_exact = false;
  return distance_within(elements, max_distance, used_exact);
}

}  // namespace

void PointsBlock::set_features(std::size_t pair, const ElementPoints& elements,
                               const ClosestFeatures& features) {
  const bool are_interiors = features.kind == ClosestFeatures::Kind::interiors;
  const std::array<std::uint8_t, 4> used =
      are_interiors ? std::array<std::uint8_t, 4>{0, 1, 2, 3}
                    : std::array<std::uint8_t, 4>{features.vertex, features.edge[0], features.edge[1], 0};
  for (std::size_t i = 0; i < 4; ++i) set(i, pair, elements.points[used[i]]);
}

std::array<std::uint8_t, 4> ends_of_code(FeatureCode code, bool are_edges) {
  static constexpr std::array<std::uint8_t, 4> of_edges[] = {{0, 1, 2, 3}, {0, 0, 2, 2}, {0, 0, 3, 3},
                                                             {1, 1, 2, 2}, {1, 1, 3, 3}, {0, 0, 2, 3},
                                                             {1, 1, 2, 3}, {0, 1, 2, 2}, {0, 1, 3, 3}};
  static constexpr std::array<std::uint8_t, 4> of_face[] = {
      {0, 0, 1, 1}, {0, 0, 1, 1}, {0, 0, 2, 2}, {0, 0, 3, 3}, {0, 0, 1, 2}, {0, 0, 1, 3}, {0, 0, 2, 3}};
  return (are_edges ? of_edges : of_face)[static_cast<std::size_t>(code)];
}

ClosestFeatures features_of_code(FeatureCode code, bool are_edges) {
  const auto [p, p_end, q, q_end] = ends_of_code(code, are_edges);
  if (code == FeatureCode::interiors) return {Features::Kind::interiors, 0, {}};
  if (p != p_end) return {Features::Kind::vertex_edge, q, {p, p_end}};
  if (q != q_end) return {Features::Kind::vertex_edge, p, {q, q_end}};
  return {Features::Kind::vertices, p, {q, 0}};
}

FeaturePair feature_pair_of(const ElementPoints& elements, const ClosestFeatures& features) {
  if (features.kind == ClosestFeatures::Kind::vertices) return FeaturePair::vertices;
  if (features.kind == ClosestFeatures::Kind::vertex_edge) return FeaturePair::vertex_edge;
  return elements.count_a == 2 ? FeaturePair::edges : FeaturePair::vertex_face;
}

std::optional<ClosestFeatures> closest_features_within(const ElementPoints& elements, double max_distance,
                                                       bool& used_exact) {
  const BoundedNumbers bounded(elements);
  FeatureSearch<BoundedNumbers> search(bounded, elements);
  std::optional<Features> features = search.search();
  std::optional<bool> is_within = features ? search.is_within(max_distance) : std::nullopt;
  if (!is_within) {
    used_exact = true;
    const IntegerNumbers integers(elements, max_distance);
    FeatureSearch<IntegerNumbers> exact_search(integers, elements);
    features = exact_search.search();
    is_within = exact_search.is_within(max_distance);
  }
  return *is_within ? features : std::nullopt;
}

ElementDistance distance_of(const ElementPoints& elements, const ClosestFeatures& features, bool& used_exact,
                            DistanceAccuracy accuracy) {
  PointsBlock block;
  DistanceNumbersBlock numbers;
  block.set_features(0, elements, features);
  compute_distance_numbers(block, 1, feature_pair_of(elements, features), accuracy, numbers);
  if (numbers.is_valid[0] != 0) return distance_of(elements, features, numbers.at(0));
  used_exact = true;
  const IntegerNumbers integers(elements, any_distance);
  ElementDistance result = distance_of(elements, features, rounded_by_integers(integers, elements, features));
  if (result.normal == Vec3d{}) result.normal = direction_across(integers, elements);
  return result;
}

ElementDistance distance_of(const ElementPoints& elements, const ClosestFeatures& features,
                            const DistanceNumbers& numbers) {
  const std::uint8_t count_a = elements.count_a;
  ElementDistance result;
  result.distance = numbers.distance;
  result.normal = numbers.direction;
  const auto on = features_of_elements(features, count_a);
  result.on_a = on[0];
  result.on_b = on[1];
  const auto set_vertex = [&](std::uint8_t vertex) {
    if (vertex < count_a)
      result.barycentric_a[vertex] = 1;
    else
      result.barycentric_b[static_cast<std::size_t>(vertex - count_a)] = 1;
  };
  switch (features.kind) {
    case Features::Kind::vertices:
      set_vertex(features.vertex);
      set_vertex(features.edge[0]);
      break;
    case Features::Kind::vertex_edge: {
      set_vertex(features.vertex);
      const bool on_b = features.vertex < count_a;
      const std::size_t base = on_b ? count_a : 0;
      auto& weights = on_b ? result.barycentric_b : result.barycentric_a;
      weights[features.edge[0] - base] = numbers.rest[0];
      weights[features.edge[1] - base] = numbers.along[0];
      if (!on_b) result.normal = -1.0 * result.normal;
      break;
    }
    case Features::Kind::interiors:
      if (count_a == 2) {
        result.barycentric_a = {numbers.rest[0], numbers.along[0], 0};
        result.barycentric_b = {numbers.rest[1], numbers.along[1], 0};
      } else {
        set_vertex(0);
        result.barycentric_b = {numbers.rest[0], numbers.along[0], numbers.along[1]};
      }
      break;
  }
  for (std::size_t i = 0; i < count_a; ++i) result.point_a += result.barycentric_a[i] * elements.points[i];
  for (std::size_t i = 0; i < elements.count_b; ++i)
    result.point_b += result.barycentric_b[i] * elements.points[count_a + i];
  return result;
}

std::array<Feature, 2> features_of_elements(const ClosestFeatures& features, std::uint8_t count_a) {
  const auto vertex_feature = [&](std::uint8_t vertex) {
    return Feature{FeatureKind::vertex,
                   static_cast<std::uint8_t>(vertex < count_a ? vertex : vertex - count_a)};
  };
  switch (features.kind) {
    case Features::Kind::vertices:
      return {vertex_feature(features.vertex), vertex_feature(features.edge[0])};
    case Features::Kind::vertex_edge: {
      const bool on_b = features.vertex < count_a;
      const std::uint8_t base = on_b ? count_a : 0;
      const Feature edge = edge_feature(static_cast<std::uint8_t>(features.edge[0] - base),
                                        static_cast<std::uint8_t>(features.edge[1] - base));
      const Feature vertex = vertex_feature(features.vertex);
      return on_b ? std::array{vertex, edge} : std::array{edge, vertex};
    }
    default:
      if (count_a == 2) return {Feature{FeatureKind::edge, 0}, Feature{FeatureKind::edge, 0}};
      return {Feature{FeatureKind::vertex, 0}, Feature{FeatureKind::face, 0}};
  }
}

std::optional<ElementDistance> distance_within(const ElementPoints& elements, double max_distance,
                                               bool& used_exact, DistanceAccuracy accuracy) {
  const auto features = closest_features_within(elements, max_distance, used_exact);
  if (!features) return {};
  return distance_of(elements, *features, used_exact, accuracy);
}

int compare_distances(const ElementPoints& p, const ElementPoints& q, bool& used_exact) {
  const BoundedNumbers bounded_p(p), bounded_q(q);
  FeatureSearch<BoundedNumbers> of_p(bounded_p, p), of_q(bounded_q, q);
  if (of_p.search() && of_q.search()) {
    if (const std::optional<int> order = of_p.compare(of_q, 0)) return *order;
  }
  used_exact = true;
  const IntegerNumbers exact_p(p, 0), exact_q(q, 0);
  FeatureSearch<IntegerNumbers> of_exact_p(exact_p, p), of_exact_q(exact_q, q);
  of_exact_p.search();
  of_exact_q.search();
  return *of_exact_p.compare(of_exact_q, exact_p.lowest() - exact_q.lowest());
}

std::optional<ElementDistance> point_point_distance(const Vec3d& a, const Vec3d& b, double max_distance) {
  return checked({{a, b}, 1, 1}, max_distance);
}
std::optional<ElementDistance> point_edge_distance(const Vec3d& a, const EdgePoints& b, double max_distance) {
  return checked({{a, b[0], b[1]}, 1, 2}, max_distance);
}
std::optional<ElementDistance> point_triangle_distance(const Vec3d& a, const TrianglePoints& b,
                                                       double max_distance) {
  return checked({{a, b[0], b[1], b[2]}, 1, 3}, max_distance);
}
std::optional<ElementDistance> edge_edge_distance(const EdgePoints& a, const EdgePoints& b,
                                                  double max_distance) {
  return checked({{a[0], a[1], b[0], b[1]}, 2, 2}, max_distance);
}

}  // namespace supple
