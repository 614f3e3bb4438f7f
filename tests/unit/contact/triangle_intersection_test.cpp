#include "supple/triangle_intersection.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace supple::triangle_intersection_test {

constexpr Feature v0{FeatureKind::vertex, 0}, v1{FeatureKind::vertex, 1}, v2{FeatureKind::vertex, 2};
constexpr Feature e0{FeatureKind::edge, 0}, e1{FeatureKind::edge, 1}, e2{FeatureKind::edge, 2};
constexpr Feature face{FeatureKind::face, 0};

constexpr IntersectionKind point = IntersectionKind::point;
constexpr IntersectionKind segment = IntersectionKind::segment;
constexpr IntersectionKind polygon = IntersectionKind::polygon;

struct Case {
  std::string name;
  TrianglePoints a, b;
  IntersectionKind kind;
  std::vector<ContactPoint> points;  // empty if the triangles are disjoint
};

void PrintTo(const Case& named, std::ostream* out) {
  *out << named.name;
}

constexpr TrianglePoints base{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

const std::vector<Case> cases{
    // Different planes
    {"PiercedByOneEdge",
     base,
     {{{1, 1, -1}, {1, 1, 1}, {9, 1, 1}}},
     segment,
     {{{3, 1, 0}, e1, face}, {{1, 1, 0}, face, e0}}},
    {"PiercedByTwoEdges",
     base,
     {{{1, 1, 1}, {1, 1, -1}, {2, 1, -1}}},
     segment,
     {{{1, 1, 0}, face, e0}, {{1.5, 1, 0}, face, e2}}},
    {"PlanesCrossOutside", base, {{{5, 5, -1}, {5, 5, 1}, {9, 9, 1}}}, point, {}},
    {"ChordsApartOnTheirLine", base, {{{5, 1, -1}, {5, 1, 1}, {9, 1, 1}}}, point, {}},
    {"ParallelPlanes", base, {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}, point, {}},
    {"VertexOnFace", base, {{{1, 1, 0}, {1, 1, 2}, {2, 1, 2}}}, point, {{{1, 1, 0}, face, v0}}},
    {"VertexOnEdge", base, {{{2, 0, 0}, {2, -1, 2}, {2, 1, 2}}}, point, {{{2, 0, 0}, e0, v0}}},
    {"VertexOnVertex", base, {{{1, 1, 2}, {0, 4, 0}, {0, 9, 3}}}, point, {{{0, 4, 0}, v2, v1}}},
    {"VertexBesideTheFace", base, {{{3, 3, 0}, {1, 1, 2}, {2, 1, 2}}}, point, {}},
    {"EdgesCrossInOnePoint", base, {{{2, -1, -1}, {2, 1, 1}, {2, -5, 0}}}, point, {{{2, 0, 0}, e0, e0}}},
    {"EdgeThroughVertex", base, {{{4, 0, -1}, {4, 0, 1}, {9, 0, 0}}}, point, {{{4, 0, 0}, v1, e0}}},
    {"EdgeInTheFace",
     base,
     {{{1, 1, 0}, {2, 1, 0}, {1, 1, 5}}},
     segment,
     {{{1, 1, 0}, face, v0}, {{2, 1, 0}, face, v1}}},
    {"EdgeThroughTheFace",
     base,
     {{{-1, 1, 0}, {9, 1, 0}, {1, 1, 5}}},
     segment,
     {{{3, 1, 0}, e1, e0}, {{0, 1, 0}, e2, e0}}},
    {"EdgeInTheFaceEndsOnItsEdge",
     base,
     {{{1, 1, 0}, {3, 1, 0}, {1, 1, 5}}},
     segment,
     {{{3, 1, 0}, e1, v1}, {{1, 1, 0}, face, v0}}},
    {"EdgeAlongEdge",
     base,
     {{{1, 0, 0}, {3, 0, 0}, {1, 0, 5}}},
     segment,
     {{{1, 0, 0}, e0, v0}, {{3, 0, 0}, e0, v1}}},
    {"EdgeAlongPartOfEdge",
     base,
     {{{3, 0, 0}, {9, 0, 0}, {1, 0, 5}}},
     segment,
     {{{4, 0, 0}, v1, e0}, {{3, 0, 0}, e0, v0}}},
    {"EdgesEndToEnd", base, {{{4, 0, 0}, {9, 0, 0}, {5, 0, 5}}}, point, {{{4, 0, 0}, v1, v0}}},
    {"EdgesApartOnOneLine", base, {{{5, 0, 0}, {9, 0, 0}, {5, 0, 5}}}, point, {}},
    {"SharedEdge",
     base,
     {{{4, 0, 0}, {0, 0, 0}, {1, 1, 5}}},
     segment,
     {{{0, 0, 0}, v0, v1}, {{4, 0, 0}, v1, v0}}},
    {"SharedVertexAndInside",
     base,
     {{{0, 0, 0}, {1, 1, 1}, {1, 1, -1}}},
     segment,
     {{{0, 0, 0}, v0, v0}, {{1, 1, 0}, face, e1}}},
    {"ChordFromVertexToEdge",
     base,
     {{{0, 0, 5}, {9, 9, -5}, {0, 0, -5}}},
     segment,
     {{{0, 0, 0}, v0, e2}, {{2, 2, 0}, e1, face}}},

    // One plane
    {"StarOfDavid",
     {{{0, 0, 0}, {6, 0, 0}, {3, 6, 0}}},
     {{{0, 4, 0}, {6, 4, 0}, {3, -2, 0}}},
     polygon,
     {{{4, 0, 0}, e0, e1},
      {{2, 0, 0}, e0, e2},
      {{1, 2, 0}, e2, e2},
      {{2, 4, 0}, e2, e0},
      {{4, 4, 0}, e1, e0},
      {{5, 2, 0}, e1, e1}}},
    {"Nested",
     base,
     {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}},
     polygon,
     {{{1, 1, 0}, face, v0}, {{2, 1, 0}, face, v1}, {{1, 2, 0}, face, v2}}},
    {"Identical", base, base, polygon, {{{0, 0, 0}, v0, v0}, {{4, 0, 0}, v1, v1}, {{0, 4, 0}, v2, v2}}},
    {"CoplanarApart", base, {{{3, 3, 0}, {9, 3, 0}, {3, 9, 0}}}, point, {}},
    {"CoplanarSharedVertex", base, {{{4, 0, 0}, {9, 0, 0}, {9, 1, 0}}}, point, {{{4, 0, 0}, v1, v0}}},
    {"CoplanarVertexOnEdge", base, {{{2, 2, 0}, {9, 2, 0}, {9, 9, 0}}}, point, {{{2, 2, 0}, e1, v0}}},
    {"CoplanarSharedEdge",
     base,
     {{{0, 0, 0}, {0, -4, 0}, {4, 0, 0}}},
     segment,
     {{{0, 0, 0}, v0, v0}, {{4, 0, 0}, v1, v2}}},
    {"CoplanarPartOfEdge",
     base,
     {{{1, 0, 0}, {0, -4, 0}, {9, 0, 0}}},
     segment,
     {{{4, 0, 0}, v1, e2}, {{1, 0, 0}, e0, v0}}},
    {"CornerCutOff",
     base,
     {{{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}}},
     polygon,
     {{{0, 0, 0}, v0, face}, {{1, 0, 0}, e0, e1}, {{0, 1, 0}, e2, e1}}},
    {"Quadrilateral",
     base,
     {{{1, 1, 0}, {9, 1, 0}, {1, -9, 0}}},
     polygon,
     {{{4, 0, 0}, v1, face}, {{1, 0, 0}, e0, e2}, {{1, 1, 0}, face, v0}, {{3, 1, 0}, e1, e0}}},

    // Triangles without area
    {"PointInFace", base, {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, point, {{{1, 1, 0}, face, v0}}},
    {"PointOnEdge", base, {{{2, 2, 0}, {2, 2, 0}, {2, 2, 0}}}, point, {{{2, 2, 0}, e1, v0}}},
    {"PointOffTheFace", base, {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, point, {}},
    {"PointAndPoint",
     {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}},
     {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}},
     point,
     {{{1, 2, 3}, v0, v0}}},
    {"PointsApart", {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}, {{{1, 2, 4}, {1, 2, 4}, {1, 2, 4}}}, point, {}},
    {"SegmentThroughFace", base, {{{1, 1, 0}, {1, 1, 3}, {1, 1, -2}}}, point, {{{1, 1, 0}, face, e1}}},
    {"SegmentThroughEdge", base, {{{2, 0, 1}, {2, 0, -1}, {2, 0, 1}}}, point, {{{2, 0, 0}, e0, e0}}},
    {"SegmentThroughVertex", base, {{{4, 0, 1}, {4, 0, -1}, {4, 0, 0}}}, point, {{{4, 0, 0}, v1, e0}}},
    {"SegmentPastTheFace", base, {{{3, 3, 1}, {3, 3, -1}, {3, 3, 0}}}, point, {}},
    {"SegmentEndsOnFace", base, {{{1, 1, 2}, {1, 1, 0}, {1, 1, 1}}}, point, {{{1, 1, 0}, face, v1}}},
    {"SegmentInThePlane",
     base,
     {{{-1, 1, 0}, {9, 1, 0}, {1, 1, 0}}},
     segment,
     {{{3, 1, 0}, e1, e0}, {{0, 1, 0}, e2, e0}}},
    {"SegmentsCross",
     {{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}}},
     {{{0, -1, 0}, {0, 0.5, 0}, {0, 1, 0}}},
     point,
     {{{0, 0, 0}, e0, e2}}},
    {"SegmentsSkew", {{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}}}, {{{0, -1, 1}, {0, 0.5, 1}, {0, 1, 1}}}, point, {}},
    {"SegmentsOverlap",
     {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
     {{{1, 1, 1}, {4, 4, 4}, {3, 3, 3}}},
     segment,
     {{{2, 2, 2}, v1, e0}, {{1, 1, 1}, e0, v0}}},
    {"SegmentsEndToEnd",
     {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
     {{{2, 2, 2}, {4, 4, 4}, {3, 3, 3}}},
     point,
     {{{2, 2, 2}, v1, v0}}},
    {"SegmentsInARow", {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}, {{{3, 3, 3}, {5, 5, 5}, {4, 4, 4}}}, point, {}},
    {"PointOnSegment",
     {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
     {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}},
     point,
     {{{1, 1, 1}, e0, v0}}},
    {"PointBesideSegment",
     {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
     {{{1, 1, 2}, {1, 1, 2}, {1, 1, 2}}},
     point,
     {}},
    {"RepeatedCornerIsNamedByTheFirst",
     base,
     {{{1, 1, 5}, {1, 1, 0}, {1, 1, 0}}},
     point,
     {{{1, 1, 0}, face, v1}}},
};

class NamedCase : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, NamedCase, ::testing::ValuesIn(cases),
                         [](const auto& named) { return named.param.name; });

TEST_P(NamedCase, HasTheKnownAnswer) {
  const auto& [name, a, b, kind, points] = GetParam();
  const TriangleIntersection result = intersect_triangles(a, b);
  EXPECT_EQ(result.intersects, !points.empty());
  EXPECT_EQ(triangles_intersect(a, b), !points.empty());
  EXPECT_EQ(triangles_intersect_by_axes(a, b), !points.empty());
  EXPECT_EQ(result.kind, kind);
  ASSERT_EQ(result.point_count, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(result.points[i], points[i]) << "point " << i;
}

TEST(TriangleIntersection, NonFiniteCoordinatesTouchNothing) {
  for (const double bad : {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()}) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        TrianglePoints broken{{{1, 1, -1}, {1, 1, 1}, {2, 1, 1}}};
        ASSERT_TRUE(triangles_intersect(base, broken));
        broken[i][axis] = bad;
        EXPECT_FALSE(triangles_intersect(base, broken));
        EXPECT_FALSE(triangles_intersect(broken, base));
        EXPECT_FALSE(intersect_triangles(base, broken).intersects);
        EXPECT_FALSE(triangles_intersect_by_axes(base, broken));
      }
    }
  }
}

TEST(TriangleIntersection, SaysWhenIntegersDecided) {
  EXPECT_FALSE(intersect_triangles(base, {{{1, 1, -1}, {1, 1, 1}, {2, 1, 1}}}).used_exact_fallback);
  // Both triangles are in the plane x + y = z, which is not special for any coordinate axis.
  EXPECT_TRUE(intersect_triangles({{{0, 0, 0}, {3, 1, 4}, {1, 3, 4}}}, {{{1, 1, 2}, {5, 1, 6}, {2, 6, 8}}})
                  .used_exact_fallback);
}

}  // namespace supple::triangle_intersection_test
