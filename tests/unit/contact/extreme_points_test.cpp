#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "supple/triangle_intersection.hpp"
#include "unit/contact/rational_clipping.hpp"
#include "unit/contact/triangle_pairs.hpp"

namespace supple::extreme_points_test {

using truth::pair_families;
using truth::PairFamily;
using truth::rational;
using truth::Rational;
using truth::RationalPoint;
using truth::scaled_count;
using truth::TrianglePair3d;

class ExtremePoints : public ::testing::TestWithParam<PairFamily> {};
INSTANTIATE_TEST_SUITE_P(All, ExtremePoints, ::testing::ValuesIn(pair_families()),
                         [](const auto& family) { return family.param.name; });

std::vector<RationalPoint> sorted(std::vector<RationalPoint> points) {
  std::sort(points.begin(), points.end());
  return points;
}

const Vec3d& corner(const TrianglePoints& triangle, int i) {
  return triangle[static_cast<std::size_t>(i % 3)];
}

/// The first of coincident corners names the vertex. The longest of collinear edges names the edge.
bool named_canonically(const TrianglePoints& triangle, Feature feature) {
  const Vec3d &first = corner(triangle, feature.index), &second = corner(triangle, feature.index + 1);
  const Vec3d& third = corner(triangle, feature.index + 2);
  if (feature.kind == FeatureKind::face) return feature.index == 0;
  for (int i = 0; i < feature.index; ++i) {
    if (feature.kind == FeatureKind::vertex && corner(triangle, i) == first) return false;
  }
  if (feature.kind == FeatureKind::vertex) return true;
  const RationalPoint edge = truth::subtract(rational(second), rational(first));
  const RationalPoint offset = truth::subtract(rational(third), rational(first));
  const RationalPoint normal = truth::cross(edge, offset);
  const Rational part = truth::dot(edge, offset);
  return normal != RationalPoint{} || (part >= 0 && part <= truth::dot(edge, edge));
}

/// The extent of an edge along one axis; 0 for other features.
Rational edge_extent(const TrianglePoints& triangle, Feature feature, std::size_t axis) {
  if (feature.kind != FeatureKind::edge) return 0;
  return abs(rational(corner(triangle, feature.index + 1))[axis] -
             rational(corner(triangle, feature.index))[axis]);
}

void expect_accurate(const TrianglePair3d& pair, const ContactPoint& point, const RationalPoint& truth) {
  const bool at_vertex = point.on_a.kind == FeatureKind::vertex || point.on_b.kind == FeatureKind::vertex;
  const RationalPoint given = rational(point.position);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double value = point.position[static_cast<int>(axis)];
    ASSERT_TRUE(std::isfinite(value));
    const double size = std::fabs(value), above = std::nextafter(size, INFINITY);
    const double step = std::isinf(above) ? size - std::nextafter(size, 0) : above - size;
    const Rational extent =
        std::max(edge_extent(pair.a, point.on_a, axis), edge_extent(pair.b, point.on_b, axis));
    const Rational allowed = extent * rational({0x1p-44, 0, 0})[0] + rational({step, 0, 0})[0] / 2;
    EXPECT_LE(abs(given[axis] - truth[axis]), at_vertex ? Rational(0) : allowed);
    for (const TrianglePoints* triangle : {&pair.a, &pair.b}) {
      const int i = static_cast<int>(axis);
      const auto [low, high] =
          std::minmax({corner(*triangle, 0)[i], corner(*triangle, 1)[i], corner(*triangle, 2)[i]});
      EXPECT_GE(value, low);
      EXPECT_LE(value, high);
    }
  }
}

void expect_convex_order(const std::vector<RationalPoint>& points) {
  RationalPoint normal{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RationalPoint& next = points[(i + 1) % points.size()];
    const RationalPoint turn = truth::cross(truth::subtract(next, points[i]),
                                            truth::subtract(points[(i + 2) % points.size()], next));
    if (i == 0) normal = turn;
    EXPECT_GT(truth::dot(turn, normal), 0);
  }
}

void expect_canonical_order(std::span<const ContactPoint> points) {
  const auto key = [](const ContactPoint& p) { return std::pair(p.on_a, p.on_b); };
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT(key(points[0]), key(points[i]));
  if (points.size() > 2) {
    EXPECT_LT(key(points[1]), key(points.back()));
  }
}

void check(const TrianglePair3d& pair) {
  const TriangleIntersection result = intersect_triangles(pair.a, pair.b);
  const std::vector<RationalPoint> truth = truth::clipped_extreme_points(pair.a, pair.b);
  ASSERT_EQ(result.point_count, truth.size());
  EXPECT_EQ(result.intersects, !truth.empty());
  std::vector<RationalPoint> found;
  for (const ContactPoint& point : result.extreme_points()) {
    found.push_back(truth::exact_meeting_point(pair.a, point.on_a, pair.b, point.on_b));
    EXPECT_TRUE(truth::in_relative_interior(found.back(), pair.a, point.on_a));
    EXPECT_TRUE(truth::in_relative_interior(found.back(), pair.b, point.on_b));
    EXPECT_TRUE(named_canonically(pair.a, point.on_a));
    EXPECT_TRUE(named_canonically(pair.b, point.on_b));
    expect_accurate(pair, point, found.back());
  }
  EXPECT_EQ(sorted(found), sorted(truth));
  expect_canonical_order(result.extreme_points());
  if (found.size() > 2) expect_convex_order(found);
  if (!found.empty()) {
    EXPECT_EQ(result.kind, found.size() == 1   ? IntersectionKind::point
                           : found.size() == 2 ? IntersectionKind::segment
                                               : IntersectionKind::polygon);
  }
}

TEST_P(ExtremePoints, AreThoseOfRationalClipping) {
  RandomNumbers random(11);
  for (int i = 0; i < scaled_count(25); ++i) {
    const TrianglePair3d pair = GetParam().draw(random);
    check(pair);
    if (HasFailure()) FAIL() << describe(pair);
  }
}

/// A point and the geometry of its features, independent of the numbering of the corners.
using Named = std::array<std::vector<std::array<double, 3>>, 3>;

std::vector<std::array<double, 3>> geometry_of(const TrianglePoints& triangle, Feature feature) {
  const auto coordinates = [](const Vec3d& p) { return std::array{p.x, p.y, p.z}; };
  std::vector<std::array<double, 3>> points;
  if (feature.kind != FeatureKind::face) points.push_back(coordinates(corner(triangle, feature.index)));
  if (feature.kind == FeatureKind::edge) points.push_back(coordinates(corner(triangle, feature.index + 1)));
  std::sort(points.begin(), points.end());
  return points;
}

enum class Positions { all, outside_faces };

/// The last bits of a point in a face depend on the order of the corners of the face.
std::vector<Named> named_points(const TrianglePoints& a, const TrianglePoints& b, bool swapped,
                                Positions positions) {
  const TriangleIntersection result = intersect_triangles(a, b);
  std::vector<Named> points;
  for (const ContactPoint& point : result.extreme_points()) {
    const bool in_face = point.on_a.kind == FeatureKind::face || point.on_b.kind == FeatureKind::face;
    std::vector<std::array<double, 3>> position;
    if (!in_face || positions == Positions::all)
      position.push_back({point.position.x, point.position.y, point.position.z});
    points.push_back({position, geometry_of(a, point.on_a), geometry_of(b, point.on_b)});
    if (swapped) std::swap(points.back()[1], points.back()[2]);
  }
  std::sort(points.begin(), points.end());
  return points;
}

TEST_P(ExtremePoints, DoNotDependOnTheOrderOfCornersOrTriangles) {
  RandomNumbers random(12);
  for (int i = 0; i < scaled_count(100); ++i) {
    const TrianglePair3d pair = GetParam().draw(random);
    const std::vector<Named> expected = named_points(pair.a, pair.b, false, Positions::outside_faces);
    ASSERT_EQ(named_points(pair.b, pair.a, true, Positions::all),
              named_points(pair.a, pair.b, false, Positions::all))
        << describe(pair);
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
      const TrianglePoints a{pair.a[order[0]], pair.a[order[1]], pair.a[order[2]]};
      const TrianglePoints b{pair.b[order[2]], pair.b[order[0]], pair.b[order[1]]};
      ASSERT_EQ(named_points(a, pair.b, false, Positions::outside_faces), expected) << describe(pair);
      ASSERT_EQ(named_points(pair.b, a, true, Positions::outside_faces), expected) << describe(pair);
      ASSERT_EQ(named_points(a, b, false, Positions::outside_faces), expected) << describe(pair);
      ASSERT_EQ(triangles_intersect(b, a), !expected.empty()) << describe(pair);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(SharedEdges, ReportTheSameBitsInBothTriangles) {
  RandomNumbers random(13);
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const TrianglePair3d pair = pair_families()[0].draw(random);
    const TriangleIntersection here = intersect_triangles(pair.a, pair.b);
    TrianglePoints neighbour = pair.a;
    std::swap(neighbour[0], neighbour[1]);
    neighbour[2] = neighbour[2] * 0.3 + pair.b[0] * 0.7;
    const TriangleIntersection there = intersect_triangles(neighbour, pair.b);
    for (const ContactPoint& p : here.extreme_points()) {
      for (const ContactPoint& q : there.extreme_points()) {
        const Feature shared{FeatureKind::edge, 0};
        if (p.on_a != shared || q.on_a != shared || p.on_b != q.on_b) continue;
        ASSERT_EQ(p.position, q.position);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

}  // namespace supple::extreme_points_test
