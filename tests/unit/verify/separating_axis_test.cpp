#include <gtest/gtest.h>

#include <limits>

#include "supple/triangle_intersection.hpp"
#include "unit/contact/triangle_pairs.hpp"

namespace supple::separating_axis_test {

using truth::pair_families;
using truth::PairFamily;
using truth::scaled_count;
using truth::TrianglePair3d;

constexpr TrianglePoints unit{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};

TEST(SeparatingAxis, DifferenceOfDimension3) {
  EXPECT_TRUE(triangles_intersect_by_axes(unit, {{{0.2, 0.2, -1}, {0.2, 0.2, 1}, {5, 5, 1}}}));
  EXPECT_FALSE(triangles_intersect_by_axes(unit, {{{0.6, 0.6, -1}, {0.6, 0.6, 1}, {5, 5, 1}}}));
  // Only the cross product of two edges separates these triangles.
  EXPECT_FALSE(triangles_intersect_by_axes({{{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}}},
                                           {{{0, -1, 0.1}, {0, 1, 0.1}, {0, 0, 1}}}));
  EXPECT_TRUE(triangles_intersect_by_axes({{{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}}},
                                          {{{0, -1, 0}, {0, 1, 0}, {0, 0, 1}}}));
}

TEST(SeparatingAxis, DifferenceOfDimension2) {
  EXPECT_FALSE(triangles_intersect_by_axes(unit, {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}));
  EXPECT_FALSE(triangles_intersect_by_axes(unit, {{{1, 1, 0}, {1, 0.5, 0}, {0.5, 1, 0}}}));
  EXPECT_TRUE(triangles_intersect_by_axes(unit, {{{1, 1, 0}, {0.5, 0.5, 0}, {0.75, 1, 0}}}));
  // Crossing segments, segments in parallel planes, and a segment that meets only the other's line.
  const TrianglePoints segment{{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}}};
  EXPECT_TRUE(triangles_intersect_by_axes(segment, {{{0, -1, 0}, {0, 1, 0}, {0, 1, 0}}}));
  EXPECT_FALSE(triangles_intersect_by_axes(segment, {{{0, -1, 1}, {0, 1, 1}, {0, 1, 1}}}));
  EXPECT_FALSE(triangles_intersect_by_axes(segment, {{{2, -1, 0}, {2, 1, 0}, {2, 1, 0}}}));
}

TEST(SeparatingAxis, DifferenceOfDimension1) {
  const TrianglePoints segment{{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}};
  EXPECT_TRUE(triangles_intersect_by_axes(segment, {{{2, 2, 2}, {3, 3, 3}, {4, 4, 4}}}));
  EXPECT_FALSE(triangles_intersect_by_axes(segment, {{{3, 3, 3}, {5, 5, 5}, {4, 4, 4}}}));
  EXPECT_FALSE(triangles_intersect_by_axes(segment, {{{0, 0, 1}, {2, 2, 3}, {1, 1, 2}}}));
  EXPECT_TRUE(triangles_intersect_by_axes(segment, {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}));
  EXPECT_FALSE(triangles_intersect_by_axes(segment, {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}));
}

TEST(SeparatingAxis, DifferenceOfDimension0) {
  const TrianglePoints point{{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}};
  EXPECT_TRUE(triangles_intersect_by_axes(point, point));
  EXPECT_FALSE(triangles_intersect_by_axes(point, {{{1, 2, 4}, {1, 2, 4}, {1, 2, 4}}}));
}

TEST(SeparatingAxis, OneStepOfADoubleDecides) {
  const double above = std::numeric_limits<double>::denorm_min();
  EXPECT_TRUE(triangles_intersect_by_axes(unit, {{{0.25, 0.25, 0}, {0.25, 0.25, 1e300}, {1, 1, 1e300}}}));
  EXPECT_FALSE(
      triangles_intersect_by_axes(unit, {{{0.25, 0.25, above}, {0.25, 0.25, 1e300}, {1, 1, 1e300}}}));
}

class Decision : public ::testing::TestWithParam<PairFamily> {};
INSTANTIATE_TEST_SUITE_P(All, Decision, ::testing::ValuesIn(pair_families()),
                         [](const auto& family) { return family.param.name; });

TEST_P(Decision, EqualsThatOfSeparatingAxes) {
  RandomNumbers random(21);
  int hits = 0;
  const int count = scaled_count(GetParam().name == "grid3" ? 20000 : 1500);
  for (int i = 0; i < count; ++i) {
    const TrianglePair3d pair = GetParam().draw(random);
    const bool expected = triangles_intersect_by_axes(pair.a, pair.b);
    ASSERT_EQ(triangles_intersect(pair.a, pair.b), expected) << describe(pair);
    ASSERT_EQ(intersect_triangles(pair.a, pair.b).intersects, expected) << describe(pair);
    hits += expected;
  }
  EXPECT_GT(hits, count / 50);
  if (GetParam().name != "identical" && GetParam().name.find("shared") == std::string::npos) {
    EXPECT_LT(hits, count - count / 50);
  }
}

}  // namespace supple::separating_axis_test
