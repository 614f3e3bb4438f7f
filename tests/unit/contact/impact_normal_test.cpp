// Normals of elements whose points coincide, at the start of a step and later. Lattice coordinates are exact.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "supple/continuous.hpp"
#include "support/random.hpp"

namespace supple::impact_normal_test {

using Points = std::array<Vec3d, 4>;

/// The directions of both elements at the impact: those of the edges of a face, or of two edges.
std::vector<Vec3d> directions_of(const Points& p, bool are_edges) {
  if (are_edges) return {p[1] - p[0], p[3] - p[2]};
  return {p[2] - p[1], p[3] - p[1], p[3] - p[2]};
}

Vec3d unit(const Vec3d& v) {
  return v / norm(v);
}

/// A random motion on a lattice that touches at the start.
struct TouchingMotion {
  Points start, end;
  bool are_edges = false;
};

TouchingMotion random_touching_motion(RandomNumbers& random) {
  TouchingMotion motion;
  motion.are_edges = random.below(2) == 0;
  const bool is_flat = random.below(3) == 0, is_in_line = random.below(6) == 0;
  const auto lattice = [&] {
    Vec3d p{static_cast<double>(random.between(-4, 4)), static_cast<double>(random.between(-4, 4)),
            static_cast<double>(random.between(-4, 4))};
    if (is_flat) p.z = p.x - p.y;
    if (is_in_line) p = p.x * Vec3d{1, 2, -1};
    return p;
  };
  for (Vec3d& p : motion.start) p = lattice();
  // Moves the first element so that a point of it is on the other one: both combinations are exact.
  auto& [p0, p1, p2, p3] = motion.start;
  const double weights[] = {0, 0.25, 0.5, 1};
  const double r = weights[random.below(4)], s = weights[random.below(4)];
  if (motion.are_edges) {
    const Vec3d offset = (p2 + s * (p3 - p2)) - (p0 + r * (p1 - p0));
    p0 += offset;
    p1 += offset;
  } else {
    p0 = p1 + r * (p2 - p1) + (1 - r) * s * (p3 - p1);
  }
  const std::uint32_t kind = random.below(4);
  const Vec3d way = lattice();
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_first = i < (motion.are_edges ? 2u : 1u);
    motion.end[i] = motion.start[i];
    if (kind == 0 && is_first) motion.end[i] += way;
    if (kind == 1) motion.end[i] += is_first ? way : -1.0 * way;
    if (kind == 2) motion.end[i] += lattice();
  }
  return motion;
}

/// Elements that share a point at the start.
TEST(ImpactNormal, AtATouchingStartIsNormalToBothElements) {
  RandomNumbers random(9);
  int sliding = 0;
  for (int i = 0; i < 20000; ++i) {
    const TouchingMotion motion = random_touching_motion(random);
    for (const double separation : {0.0, 0.125}) {
      const ImpactOptions options{.min_separation = separation};
      const auto impact = motion.are_edges
                              ? first_impact(EdgeEdgeMotion{motion.start, motion.end}, options)
                              : first_impact(VertexFaceMotion{motion.start, motion.end}, options);
      ASSERT_TRUE(impact && impact->touching_at_start) << i;
      const std::vector<Vec3d> directions = directions_of(motion.start, motion.are_edges);
      const bool are_points = std::ranges::all_of(directions, [](const Vec3d& d) { return d == Vec3d{}; });
      if (are_points && impact->normal == Vec3d{}) continue;
      ASSERT_NEAR(norm(impact->normal), 1, 1e-14) << i;
      for (const Vec3d& d : directions) {
        if (d == Vec3d{}) continue;
        ASSERT_NEAR(dot(unit(d), impact->normal), 0, 1e-12) << i << " edges: " << motion.are_edges;
      }
      sliding += motion.end != motion.start ? 1 : 0;
    }
  }
  EXPECT_GT(sliding, 1000);
}

/// Elements that touch later, in lattice coordinates: often in one plane.
TEST(ImpactNormal, WherePointsCoincideIsNormalToBothElements) {
  RandomNumbers random(10);
  int checked = 0;
  for (int i = 0; i < 30000; ++i) {
    TouchingMotion motion = random_touching_motion(random);
    // The touching positions are in the middle of the step.
    const Points middle = motion.start;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3d way = motion.end[k] - motion.start[k];
      motion.start[k] -= way;
      motion.end[k] = motion.start[k] + 2.0 * way;
    }
    const auto impact = motion.are_edges ? first_impact(EdgeEdgeMotion{motion.start, motion.end})
                                         : first_impact(VertexFaceMotion{motion.start, motion.end});
    ASSERT_TRUE(impact) << i;
    if (impact->toi < 0.5 - 1e-8 || impact->touching_at_start) continue;  // they touched before
    const std::vector<Vec3d> directions = directions_of(middle, motion.are_edges);
    const Vec3d u = directions[0], w = directions[1], across = cross(u, w);
    if (across == Vec3d{}) continue;
    ASSERT_NEAR(std::abs(dot(unit(across), impact->normal)), 1, 1e-9) << i << " " << motion.are_edges;
    ++checked;
  }
  EXPECT_GT(checked, 1000);
}

/// A vertex that starts on a face and slides on it, in all directions and on tilted faces.
TEST(ImpactNormal, OfAVertexThatSlidesIsThatOfTheFace) {
  const Vec3d v{0.25, 0, 0.25};
  for (const Vec3d& way : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0.5}, Vec3d{0, 0, 3}, Vec3d{1e-9, 0, 0}, Vec3d{}}) {
    const auto impact = first_impact(
        VertexFaceMotion{{v, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {v + way, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}});
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->normal, (Vec3d{0, -1, 0}));
  }
}

/// Edges at a small angle: the normal needs more than double precision.
TEST(ImpactNormal, OfEdgesThatAreNearlyParallelIsNormalToBoth) {
  for (const double angle : {1e-3, 1e-6, 1e-9, 1e-11}) {
    const Vec3d a{0.3, 0.7, 0.648}, b = a + angle * Vec3d{0.8, -0.1, 0.35};
    const Points start{-1.0 * a, a, -1.0 * b, b};
    Points end = start;
    for (std::size_t i = 0; i < 2; ++i) end[i] += 0.5 * a;
    const auto impact = first_impact(EdgeEdgeMotion{start, end});
    ASSERT_TRUE(impact && impact->touching_at_start);
    EXPECT_NEAR(dot(unit(a), impact->normal), 0, 1e-15) << angle;
    EXPECT_NEAR(dot(unit(b), impact->normal), 0, 1e-15) << angle;
  }
}

TEST(ImpactNormal, OfPointsAndEdgesOnOneLineIsAcrossIt) {
  // A point slides on an edge, from its end and from within.
  for (const double x : {0.0, 0.5}) {
    const auto impact = first_impact(PointEdgeMotion{{Vec3d{x, 0, 0}, {0, 0, 0}, {1, 0, 0}},
                                                     {Vec3d{x + 0.25, 0, 0}, {0, 0, 0}, {1, 0, 0}}});
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->normal.x, 0);
    EXPECT_EQ(std::abs(impact->normal.y), 1) << "in the plane of two-dimensional elements";
  }
  // It meets the end of the edge: back along the line.
  const auto end_to_end = first_impact(
      PointEdgeMotion{{Vec3d{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {Vec3d{1, 0, 0}, {0, 0, 0}, {1, 0, 0}}});
  ASSERT_TRUE(end_to_end);
  EXPECT_EQ(end_to_end->normal, (Vec3d{-1, 0, 0}));
  // Two points that coincide: against the motion.
  const auto points =
      first_impact(PointPointMotion{{Vec3d{1, 1, 0}, {1, 1, 0}}, {Vec3d{1, 4, 0}, {1, 1, 0}}});
  ASSERT_TRUE(points);
  EXPECT_EQ(points->normal, (Vec3d{0, -1, 0}));
}

}  // namespace supple::impact_normal_test
