// Compares distances with rationals, which try every pair of features.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/distance.hpp"
#include "supple/error.hpp"
#include "support/soups.hpp"
#include "verify/algebra/distance_algebra.hpp"

namespace supple::element_distance_test {

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

void expect_truth(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  const ExactDistance truth = distance_by_algebra(a, b);
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

}  // namespace supple::element_distance_test
