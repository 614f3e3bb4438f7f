// Compares distances with rationals, which try every pair of features.

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/distance.hpp"
#include "supple/error.hpp"
#include "support/soups.hpp"

namespace supple {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using RationalVector = std::array<Rational, 3>;

RationalVector exact(const Vec3d& v) {
  return {Rational(v.x), Rational(v.y), Rational(v.z)};
}
RationalVector minus(const RationalVector& a, const RationalVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Rational dot_of(const RationalVector& a, const RationalVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A part of an element: its vertices by index, and its place in the order of ties.
struct Part {
  Feature feature;
  std::vector<std::size_t> vertices;
  int order;
};

std::vector<Part> parts_of(std::size_t vertices) {
  std::vector<Part> parts;
  for (std::uint8_t v = 0; v < vertices; ++v) parts.push_back({{FeatureKind::vertex, v}, {v}, v});
  if (vertices == 2) parts.push_back({{FeatureKind::edge, 0}, {0, 1}, 0});
  if (vertices == 3) {
    parts.push_back({{FeatureKind::edge, 0}, {0, 1}, 0});
    parts.push_back({{FeatureKind::edge, 2}, {0, 2}, 1});
    parts.push_back({{FeatureKind::edge, 1}, {1, 2}, 2});
    parts.push_back({{FeatureKind::face, 0}, {0, 1, 2}, 0});
  }
  return parts;
}

struct Truth {
  Rational squared = -1;
  std::tuple<int, int, int, int> rank{};
  Feature on_a, on_b;
  std::array<Rational, 3> weights_a, weights_b;
};

/// The closest points inside two parts: weights at which the difference of the points is normal to both.
/// Returns false when there are none, or a whole line of them.
bool closest_inside(const std::vector<RationalVector>& a, const std::vector<RationalVector>& b,
                    Truth& truth) {
  std::vector<RationalVector> sides;  // the difference is w + sum of x[i] sides[i]
  for (std::size_t i = 1; i < a.size(); ++i) sides.push_back(minus(a[i], a[0]));
  for (std::size_t i = 1; i < b.size(); ++i) sides.push_back(minus(b[0], b[i]));
  const RationalVector w = minus(a[0], b[0]);
  std::vector<Rational> x(sides.size());
  if (sides.size() == 1) {
    const Rational length = dot_of(sides[0], sides[0]);
    if (length == 0) return false;
    x[0] = -dot_of(w, sides[0]) / length;
  } else if (sides.size() == 2) {
    const Rational g00 = dot_of(sides[0], sides[0]), g01 = dot_of(sides[0], sides[1]),
                   g11 = dot_of(sides[1], sides[1]), determinant = g00 * g11 - g01 * g01;
    if (determinant == 0) return false;
    const Rational r0 = -dot_of(w, sides[0]), r1 = -dot_of(w, sides[1]);
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
  truth.squared = dot_of(difference, difference);
  return inside_a && inside_b;
}

Truth truth_of(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  Truth best;
  for (const Part& of_a : parts_of(a.size())) {
    for (const Part& of_b : parts_of(b.size())) {
      const std::size_t dimension = of_a.vertices.size() + of_b.vertices.size() - 2;
      if (dimension > 2) continue;
      std::vector<RationalVector> points_a, points_b;
      for (const std::size_t v : of_a.vertices) points_a.push_back(exact(a[v]));
      for (const std::size_t v : of_b.vertices) points_b.push_back(exact(b[v]));
      Truth truth;
      if (!closest_inside(points_a, points_b, truth)) continue;
      truth.on_a = of_a.feature;
      truth.on_b = of_b.feature;
      truth.rank = {static_cast<int>(dimension), of_a.vertices.size() > 1, of_a.order, of_b.order};
      const auto spread = [](std::array<Rational, 3>& weights, const Part& part) {
        std::array<Rational, 3> result;
        for (std::size_t i = 0; i < part.vertices.size(); ++i) result[part.vertices[i]] = weights[i];
        weights = result;
      };
      spread(truth.weights_a, of_a);
      spread(truth.weights_b, of_b);
      const bool is_better = best.squared < 0 || truth.squared < best.squared ||
                             (truth.squared == best.squared && truth.rank < best.rank);
      if (is_better) best = truth;
    }
  }
  return best;
}

std::optional<ElementDistance> distance_of(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b,
                                           double most = any_distance) {
  if (a.size() == 2) return edge_edge_distance({a[0], a[1]}, {b[0], b[1]}, most);
  if (b.size() == 1) return point_point_distance(a[0], b[0], most);
  if (b.size() == 2) return point_edge_distance(a[0], {b[0], b[1]}, most);
  return point_triangle_distance(a[0], {b[0], b[1], b[2]}, most);
}

double after(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity());
}

/// Whether the distance is within 4 units in the last place of the root of `squared`.
bool is_accurate(double distance, const Rational& squared) {
  double low = distance, high = distance;
  for (int i = 0; i < 4; ++i) {
    low = std::max(0.0, std::nextafter(low, 0.0));
    high = after(high);
  }
  return Rational(low) * Rational(low) <= squared && squared <= Rational(high) * Rational(high);
}

void expect_truth(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  const Truth truth = truth_of(a, b);
  const std::optional<ElementDistance> found = distance_of(a, b);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->on_a, truth.on_a);
  EXPECT_EQ(found->on_b, truth.on_b);
  EXPECT_TRUE(is_accurate(found->distance, truth.squared)) << found->distance;
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found->barycentric_a[i], static_cast<double>(truth.weights_a[i]), 0x1p-50);
    EXPECT_NEAR(found->barycentric_b[i], static_cast<double>(truth.weights_b[i]), 0x1p-50);
  }
  for (const auto* element : {&a, &b}) {
    for (const Vec3d& p : *element) size = std::max(size, largest_magnitude(p));
  }
  EXPECT_NEAR(dot(found->normal, found->normal), 1, 0x1p-50);
  const Vec3d between = (1 / size) * found->point_a - (1 / size) * found->point_b;
  if (size > 1e-290) {
    EXPECT_NEAR(dot(between, found->normal), found->distance / size, 0x1p-48);
    EXPECT_LE(largest_magnitude(between - (found->distance / size) * found->normal), 0x1p-48);
  }

  // The bound decides as exact arithmetic does: the two doubles at the root.
  double inside = found->distance;
  while (Rational(inside) * Rational(inside) < truth.squared) inside = after(inside);
  while (inside > 0) {
    const double before = std::nextafter(inside, 0.0);
    if (Rational(before) * Rational(before) < truth.squared) break;
    inside = before;
  }
  EXPECT_EQ(distance_of(a, b, inside), found);
  if (inside > 0) {
    EXPECT_FALSE(distance_of(a, b, std::nextafter(inside, 0.0)));
  }
}

constexpr std::array<std::array<std::size_t, 2>, 4> sizes{{{1, 1}, {1, 2}, {1, 3}, {2, 2}}};

void expect_truth_of_all(const std::vector<Vec3d>& points) {
  for (const auto& [a, b] : sizes) {
    expect_truth({points.begin(), points.begin() + static_cast<std::ptrdiff_t>(a)},
                 {points.begin() + static_cast<std::ptrdiff_t>(a),
                  points.begin() + static_cast<std::ptrdiff_t>(a + b)});
  }
}

TEST(ElementDistance, OfRandomElements) {
  RandomNumbers random(1);
  for (int i = 0; i < 1000; ++i) {
    std::vector<Vec3d> points;
    for (int p = 0; p < 4; ++p) points.push_back(random.vector(1));
    expect_truth_of_all(points);
  }
}

/// On a lattice many features tie: parallel edges, flat triangles, points that coincide.
TEST(ElementDistance, OnALattice) {
  RandomNumbers random(2);
  for (const double unit : {1.0, 0.1, 1e-3}) {
    for (int i = 0; i < 1000; ++i) {
      std::vector<Vec3d> points;
      for (int p = 0; p < 4; ++p) {
        const Vec3d v = random.vector(1.5);
        points.push_back({unit * std::round(v.x), unit * std::round(v.y), unit * std::round(v.z)});
      }
      expect_truth_of_all(points);
    }
  }
}

TEST(ElementDistance, OfNearlyTouchingAndNearlyParallelElements) {
  RandomNumbers random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = random.vector(1), b = random.vector(1), c = random.vector(1);
    const double gap = std::ldexp(1.0, -static_cast<int>(3 + i % 80));
    const double s = (i % 7) / 6.0, r = (i % 5) / 8.0;
    const Vec3d inside = (1 - s) * a + s * ((1 - r) * b + r * c);
    const Vec3d shift = random.vector(gap);
    expect_truth_of_all({inside + shift, a, b, c});
    expect_truth_of_all({a, b, a + shift, b + random.vector(gap)});                 // nearly parallel
    expect_truth_of_all({inside, a, b, (1 - s) * a + s * b + random.vector(gap)});  // needles
  }
}

TEST(ElementDistance, OfAnySize) {
  RandomNumbers random(4);
  for (const double size : {1e30, 1e-30, 1e150, 1e-150, 1e300, 1e-300, 5e-324}) {
    for (int i = 0; i < 60; ++i) {
      std::vector<Vec3d> points;
      for (int p = 0; p < 4; ++p) points.push_back(size * random.vector(1));
      expect_truth_of_all(points);
      points[static_cast<std::size_t>(i % 4)] = random.vector(1e-3);  // sizes mixed
      expect_truth_of_all(points);
    }
  }
}

TEST(ElementDistance, FarFromTheOrigin) {
  RandomNumbers random(5);
  for (int i = 0; i < 1000; ++i) {
    std::vector<Vec3d> points;
    const Vec3d center = random.vector(1e6);
    for (int p = 0; p < 4; ++p) points.push_back(center + random.vector(1e-3));
    expect_truth_of_all(points);
  }
}

TEST(ElementDistance, KnowsTheSideAtDistance0) {
  const TrianglePoints face{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const auto inside = point_triangle_distance({0.25, 0.25, 0}, face),
             corner = point_triangle_distance({0, 0, 0}, face);
  EXPECT_EQ(inside->distance, 0);
  EXPECT_EQ(inside->normal, (Vec3d{0, 0, 1}));
  EXPECT_EQ(corner->normal, (Vec3d{0, 0, 1}));
  EXPECT_EQ(edge_edge_distance({{{-1, 0, 0}, {1, 0, 0}}}, {{{0, -1, 0}, {0, 1, 0}}})->normal,
            (Vec3d{0, 0, 1}));
  EXPECT_EQ(point_point_distance({1, 2, 3}, {1, 2, 3})->normal, (Vec3d{1, 0, 0}));
  const auto on_edge = point_edge_distance({0, 0, 0.5}, {{{0, 0, 0}, {0, 0, 1}}});
  EXPECT_EQ(on_edge->distance, 0);
  EXPECT_EQ(on_edge->normal.z, 0);
}

TEST(ElementDistance, OfBadInput) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = any_distance;
  EXPECT_FALSE(point_point_distance({nan, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(point_edge_distance({0, 0, 0}, {{{0, 0, 0}, {0, inf, 1}}}));
  EXPECT_THROW(point_point_distance({0, 0, 0}, {0, 0, 0}, -1), Error);
  EXPECT_THROW(point_point_distance({0, 0, 0}, {0, 0, 0}, nan), Error);
  EXPECT_TRUE(point_point_distance({0, 0, 0}, {0, 0, 0}, 0));
}

}  // namespace
}  // namespace supple
