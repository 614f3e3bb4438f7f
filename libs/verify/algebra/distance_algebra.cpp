#include "verify/algebra/distance_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

namespace supple {

using sturm::Integer;

namespace {

/// A part of an element: its vertices by index, and its place in the order of ties.
struct FeaturePart {
  Feature feature;
  std::vector<std::size_t> vertices;
  int order;
};

std::vector<FeaturePart> parts_of(std::size_t vertices) {
  std::vector<FeaturePart> parts;
  for (std::uint8_t v = 0; v < vertices; ++v) parts.push_back({{FeatureKind::vertex, v}, {v}, v});
  if (vertices > 1) parts.push_back({{FeatureKind::edge, 0}, {0, 1}, 0});
  if (vertices == 3) {
    parts.push_back({{FeatureKind::edge, 2}, {0, 2}, 1});
    parts.push_back({{FeatureKind::edge, 1}, {1, 2}, 2});
    parts.push_back({{FeatureKind::face, 0}, {0, 1, 2}, 0});
  }
  return parts;
}

/// The closest points inside two parts: weights at which the difference of the points is normal to both.
/// Returns false when there are none, or a whole line of them.
bool closest_inside(const std::vector<RationalVector>& a, const std::vector<RationalVector>& b,
                    ExactDistance& truth) {
  std::vector<RationalVector> sides;  // the difference is w + sum of x[i] sides[i]
  for (std::size_t i = 1; i < a.size(); ++i) sides.push_back(minus(a[i], a[0]));
  for (std::size_t i = 1; i < b.size(); ++i) sides.push_back(minus(b[0], b[i]));
  const RationalVector w = minus(a[0], b[0]);
  std::vector<Rational> x(sides.size());
  if (sides.size() == 1) {
    const Rational length = dot(sides[0], sides[0]);
    if (length == 0) return false;
    x[0] = -dot(w, sides[0]) / length;
  } else if (sides.size() == 2) {
    const Rational g00 = dot(sides[0], sides[0]), g01 = dot(sides[0], sides[1]),
                   g11 = dot(sides[1], sides[1]), determinant = g00 * g11 - g01 * g01;
    if (determinant == 0) return false;
    const Rational r0 = -dot(w, sides[0]), r1 = -dot(w, sides[1]);
    x[0] = (r0 * g11 - r1 * g01) / determinant;
    x[1] = (g00 * r1 - g01 * r0) / determinant;
  }
  RationalVector difference = w;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) difference[axis] += x[i] * sides[i][axis];
  }
  std::size_t next = 0;
  const auto set_weights = [&](std::size_t count, std::array<Rational, 3>& weights) {
    weights = {1, 0, 0};
    for (std::size_t i = 1; i < count; ++i) {
      weights[i] = x[next++];
      weights[0] -= weights[i];
    }
    return std::all_of(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(count),
                       [](const Rational& weight) { return weight > 0; });
  };
  const bool inside_a = set_weights(a.size(), truth.weights_a),
             inside_b = set_weights(b.size(), truth.weights_b);
  truth.squared = dot(difference, difference);
  return inside_a && inside_b;
}

using Rank = std::tuple<int, int, int, int>;

}  // namespace

ExactDistance distance_by_algebra(std::span<const Vec3d> a, std::span<const Vec3d> b) {
  ExactDistance best;
  std::optional<Rank> best_rank;
  for (const FeaturePart& of_a : parts_of(a.size())) {
    for (const FeaturePart& of_b : parts_of(b.size())) {
      const std::size_t dimension = of_a.vertices.size() + of_b.vertices.size() - 2;
      if (dimension > 2) continue;
      std::vector<RationalVector> points_a, points_b;
      for (const std::size_t v : of_a.vertices) points_a.push_back(exact(a[v]));
      for (const std::size_t v : of_b.vertices) points_b.push_back(exact(b[v]));
      ExactDistance found;
      if (!closest_inside(points_a, points_b, found)) continue;
      found.on_a = of_a.feature;
      found.on_b = of_b.feature;
      const Rank rank{static_cast<int>(dimension), of_a.vertices.size() > 1, of_a.order, of_b.order};
      const bool is_better =
          !best_rank || found.squared < best.squared || (found.squared == best.squared && rank < *best_rank);
      if (!is_better) continue;
      const auto spread = [](std::array<Rational, 3>& weights, const FeaturePart& part) {
        std::array<Rational, 3> result;
        for (std::size_t i = 0; i < part.vertices.size(); ++i) result[part.vertices[i]] = weights[i];
        weights = result;
      };
      spread(found.weights_a, of_a);
      spread(found.weights_b, of_b);
      best = found;
      best_rank = rank;
    }
  }
  return best;
}

bool cross_by_algebra(const std::array<Vec3d, 2>& edge, const std::array<Vec3d, 3>& face) {
  // edge[0] + t along = face[0] + p u + q v, by Cramer's rule.
  const RationalVector start = exact(edge[0]), along = minus(exact(edge[1]), start), corner = exact(face[0]),
                       u = minus(exact(face[1]), corner), v = minus(exact(face[2]), corner),
                       w = minus(corner, start);
  const auto determinant = [](const RationalVector& x, const RationalVector& y, const RationalVector& z) {
    return dot(x, cross(y, z));
  };
  const Rational whole = determinant(along, u, v);
  if (whole == 0) return false;
  const Rational t = determinant(w, u, v) / whole, p = determinant(along, v, w) / whole,
                 q = determinant(along, w, u) / whole;
  return t > 0 && t < 1 && p > 0 && q > 0 && p + q < 1;
}

Rational squared(double value) {
  return Rational(value) * Rational(value);
}

bool is_accurate(double distance, const Integer& over, const Integer& under) {
  // The sign of the difference of a square and the exact one.
  const auto compare_square = [&](double value) {
    const int lowest = std::min(sturm::lowest_bit(value), 0);
    const Integer root = sturm::to_integer(value, lowest);
    return Integer(root * root * under).compare(Integer(over << -2 * lowest));
  };
  if (std::isinf(distance) && distance > 0) return compare_square(std::numeric_limits<double>::max()) < 0;
  if (!(distance >= 0)) return false;
  double low = distance, high = distance;
  for (int i = 0; i < 4; ++i) {
    low = std::max(0.0, std::nextafter(low, 0.0));
    high = std::nextafter(high, std::numeric_limits<double>::infinity());
  }
  return compare_square(low) <= 0 && (std::isinf(high) || compare_square(high) >= 0);
}

/// The root of an integer, which is the number times a power of 4.
double rounded_root(const Rational& squared) {
  if (squared == 0) return 0;
  boost::multiprecision::cpp_int over = numerator(squared), under = denominator(squared);
  int shift = 126 + static_cast<int>(msb(under)) - static_cast<int>(msb(over));
  shift -= shift % 2;
  (shift > 0 ? over : under) <<= std::abs(shift);
  const boost::multiprecision::cpp_int scaled = over / under;
  return std::ldexp(sqrt(scaled).convert_to<double>(), -shift / 2);
}

}  // namespace supple
