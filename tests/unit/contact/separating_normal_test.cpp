#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "supple/triangle_intersection.hpp"
#include "support/random.hpp"
#include "unit/contact/triangle_pairs.hpp"

namespace supple::separating_normal_test {

using truth::pair_families;
using truth::PairFamily;
using truth::scaled_count;
using truth::TrianglePair3d;

using Exact = long double;
using Vec3l = Vec3<Exact>;

Vec3l wide(const Vec3d& v) {
  return {v.x, v.y, v.z};
}

/// Corners relative to corner 0 of a, divided by the largest extent, which may have any size.
struct RelativePair {
  std::array<Vec3l, 3> a, b;
  Exact size = 0;

  explicit RelativePair(const TrianglePair3d& pair) {
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = wide(pair.a[i]) - wide(pair.a[0]);
      b[i] = wide(pair.b[i]) - wide(pair.a[0]);
    }
    for (const auto& corners : {a, b}) {
      for (const Vec3l& p : corners) size = std::max({size, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    if (size == 0) return;
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = a[i] / size;
      b[i] = b[i] / size;
    }
  }

  /// The distance that a must move along the unit vector n until a plane with this normal separates a and b.
  Exact depth(const Vec3l& n) const {
    const auto along = [&](const Vec3l& p) { return dot(n, p); };
    const auto [b0, b1, b2] = b;
    return std::max({along(b0), along(b1), along(b2)}) - std::min({along(a[0]), along(a[1]), along(a[2])});
  }
};

Vec3l unit(const Vec3l& v) {
  return v / norm(v);
}

Vec3l random_direction(RandomNumbers& random) {
  for (;;) {
    const Vec3l v = wide(random.vector(1));
    if (norm(v) > 0.01L && norm(v) < 1) return unit(v);
  }
}

/// Candidates for the best direction: the face normals of the Minkowski difference of the two triangles.
std::vector<Vec3l> face_normals(const RelativePair& pair) {
  std::vector<Vec3l> directions;
  const auto add = [&](const Vec3l& p, const Vec3l& q) {
    const Vec3l direction = cross(p, q);
    if (!(norm(direction) > 1e-5L * norm(p) * norm(q))) return;
    directions.push_back(unit(direction));
    directions.push_back(-unit(direction));
  };
  const auto edge = [](const std::array<Vec3l, 3>& t, std::size_t i) { return t[(i + 1) % 3] - t[i]; };
  add(edge(pair.a, 0), edge(pair.a, 1));
  add(edge(pair.b, 0), edge(pair.b, 1));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) add(edge(pair.a, i), edge(pair.b, j));
  }
  return directions;
}

class SeparatingNormals : public ::testing::TestWithParam<PairFamily> {};
INSTANTIATE_TEST_SUITE_P(All, SeparatingNormals, ::testing::ValuesIn(pair_families()),
                         [](const auto& family) { return family.param.name; });

TEST_P(SeparatingNormals, AreUnitVectorsOfLeastDepth) {
  RandomNumbers random(7);
  int intersecting = 0;
  for (int i = 0; i < scaled_count(1000); ++i) {
    const TrianglePair3d pair = GetParam().draw(random);
    const TriangleIntersection shared = intersect_triangles(pair.a, pair.b);
    if (!shared.intersects) {
      ASSERT_EQ(shared.normal, Vec3d{});
      continue;
    }
    ++intersecting;
    ASSERT_NEAR(norm(shared.normal), 1, 1e-15) << describe(pair);
    const RelativePair relative(pair);
    const Exact depth = relative.depth(wide(shared.normal));
    ASSERT_GE(depth, -1e-5L) << describe(pair);
    // Edges at an angle below 2^-20 count as parallel, hence the tolerance.
    for (const Vec3l& direction : face_normals(relative))
      ASSERT_GE(relative.depth(direction), depth - 1e-5L) << describe(pair);
    for (int k = 0; k < 20; ++k) {
      ASSERT_GE(relative.depth(random_direction(random)), depth - 1e-5L) << describe(pair);
      const Vec3l near = wide(shared.normal) + 0.05L * random_direction(random);
      ASSERT_GE(relative.depth(unit(near)), depth - 1e-5L) << describe(pair);
    }
  }
  EXPECT_GT(intersecting, 0);
}

TrianglePair3d random_pair(RandomNumbers& random) {
  TrianglePair3d pair;
  for (TrianglePoints* const triangle : {&pair.a, &pair.b}) {
    for (Vec3d& p : *triangle) p = random.vector(1);
  }
  return pair;
}

TEST(SeparatingNormal, SeparatesByTheShortestWay) {
  RandomNumbers random(3);
  int intersecting = 0;
  for (int i = 0; i < scaled_count(2000); ++i) {
    const TrianglePair3d pair = random_pair(random);
    const TriangleIntersection shared = intersect_triangles(pair.a, pair.b);
    if (!shared.intersects) continue;
    ++intersecting;
    const RelativePair relative(pair);
    const auto depth = static_cast<double>(relative.depth(wide(shared.normal)) * relative.size);
    for (const Vec3l& direction : face_normals(relative))
      ASSERT_GE(relative.depth(direction) * relative.size, depth - 1e-10) << describe(pair);
    TrianglePoints moved = pair.a;
    for (Vec3d& p : moved) p += (depth + 1e-9) * shared.normal;
    ASSERT_FALSE(triangles_intersect(moved, pair.b)) << describe(pair);
    // The depth is the same with a and b swapped.
    const RelativePair back(TrianglePair3d{pair.b, pair.a});
    const Vec3d back_normal = intersect_triangles(pair.b, pair.a).normal;
    ASSERT_NEAR(static_cast<double>(back.depth(wide(back_normal)) * back.size), depth, 1e-9);
  }
  EXPECT_GT(intersecting, scaled_count(100));
}

TEST(SeparatingNormal, HasTheSameBitsAtAnyScale) {
  RandomNumbers random(5);
  for (int i = 0; i < scaled_count(200); ++i) {
    const TrianglePair3d pair = random_pair(random);
    const Vec3d normal = intersect_triangles(pair.a, pair.b).normal;
    for (const int exponent : {-900, -200, -79, 79, 200, 1000}) {
      TrianglePair3d scaled = pair;
      for (TrianglePoints* const triangle : {&scaled.a, &scaled.b}) {
        for (Vec3d& p : *triangle)
          p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
      }
      ASSERT_EQ(intersect_triangles(scaled.a, scaled.b).normal, normal) << exponent << describe(pair);
    }
  }
}

struct Case {
  std::string name;
  TrianglePoints a, b;
  Vec3d normal;
};

void PrintTo(const Case& named, std::ostream* out) {
  *out << named.name;
}

constexpr TrianglePoints floor_triangle{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
constexpr TrianglePoints floor_upside_down{{{0, 0, 0}, {0, 4, 0}, {4, 0, 0}}};
constexpr double huge = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min();
const double half_root = std::sqrt(0.5);

const std::vector<Case> cases{
    {"TipFromAbove", {{{1, 1, -0.25}, {0, 1, 3}, {2, 1, 3}}}, floor_triangle, {0, 0, 1}},
    {"TipFromBelow", {{{1, 1, 0.25}, {0, 1, -3}, {2, 1, -3}}}, floor_triangle, {0, 0, -1}},
    {"FloorOnATip", floor_triangle, {{{1, 1, 0.25}, {0, 1, -3}, {2, 1, -3}}}, {0, 0, 1}},
    {"WindingDoesNotMatter", {{{1, 1, -0.25}, {0, 1, 3}, {2, 1, 3}}}, floor_upside_down, {0, 0, 1}},
    {"VertexTouchesFace", {{{1, 1, 0}, {0, 1, 3}, {2, 1, 3}}}, floor_triangle, {0, 0, 1}},
    {"EdgesTouch", {{{2, 0, 0}, {2, 0, -4}, {1, -4, -2}}}, floor_triangle, {0, 0, -1}},
    {"EdgesCrossAtTheRim", {{{2, 0.5, 3}, {2, 0.5, -3}, {2, -9, 0}}}, floor_triangle, {0, -1, 0}},
    {"EdgeInTheFace", {{{1, 1, 0}, {2, 1, 0}, {1, 1, 5}}}, floor_triangle, {0, 0, 1}},
    {"Coplanar", {{{1, 1, 0}, {5, 1, 0}, {1, 5, 0}}}, floor_triangle, {0, 0, 1}},
    {"CoplanarUpsideDown", {{{1, 1, 0}, {5, 1, 0}, {1, 5, 0}}}, floor_upside_down, {0, 0, -1}},
    {"SegmentThroughFace", {{{1, 1, -1}, {1, 1, 3}, {1, 1, 1}}}, floor_triangle, {0, 0, 1}},
    {"SegmentInFace", {{{1, 1, 0}, {2, 1, 0}, {2, 1, 0}}}, floor_triangle, {0, 0, 1}},
    {"PointOnFace", {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, floor_upside_down, {0, 0, -1}},
    {"FaceUnderPoint", floor_upside_down, {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, {0, 0, -1}},
    {"SegmentsCross", {{{-1, 0, 0}, {1, 0, 0}, {1, 0, 0}}}, {{{0, -1, 0}, {0, 1, 0}, {0, 0, 0}}}, {0, 0, 1}},
    {"SegmentsOnOneLine",
     {{{0, 0, 0}, {3, 3, 0}, {1, 1, 0}}},
     {{{2, 2, 0}, {5, 5, 0}, {5, 5, 0}}},
     {half_root, -half_root, 0}},
    {"SamePoint", {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, {1, 0, 0}},
    {"LargestNumbers",
     {{{0, 0, -huge / 4}, {0, 0, huge}, {0, 0, huge}}},
     {{{-huge, -huge, 0}, {huge, -huge, 0}, {0, huge, 0}}},
     {0, 0, 1}},
    {"SmallestNumbers",
     {{{0, 0, 0}, {0, 0, tiny}, {0, tiny, tiny}}},
     {{{0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}}},
     {0, 0, 1}},
};

class NamedNormals : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, NamedNormals, ::testing::ValuesIn(cases),
                         [](const auto& named) { return named.param.name; });

TEST_P(NamedNormals, AreAsDocumented) {
  const TriangleIntersection shared = intersect_triangles(GetParam().a, GetParam().b);
  ASSERT_TRUE(shared.intersects);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(shared.normal[axis], GetParam().normal[axis], 1e-15) << axis;
}

TEST(UnitNormal, IsThatOfTheCornersInOrder) {
  EXPECT_EQ(unit_normal(floor_triangle), (Vec3d{0, 0, 1}));
  EXPECT_EQ(unit_normal({{{0, 0, 0}, {0, 0, 1e-300}, {0, 1e-300, 0}}}), (Vec3d{-1, 0, 0}));
  EXPECT_EQ(unit_normal({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}}), Vec3d{});
  EXPECT_EQ(unit_normal({{{0, 0, 0}, {1, 0, 0}, {0, INFINITY, 0}}}), Vec3d{});
  EXPECT_EQ(area(floor_triangle), 8);
  EXPECT_EQ(area({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}}), 0);
}

}  // namespace supple::separating_normal_test
