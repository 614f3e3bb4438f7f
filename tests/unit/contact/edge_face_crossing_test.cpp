// Edges that cross faces, against rationals and against the intersection of triangles.

#include "contact/distance/edge_face_crossing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/vector.hpp"
#include "support/random.hpp"
#include "verify/algebra/distance_algebra.hpp"

namespace supple::edge_face_crossing_test {

Vec3d lattice_point(RandomNumbers& random, int size) {
  Vec3d p;
  for (int axis = 0; axis < 3; ++axis) p[axis] = random.between(-size, size);
  return p;
}

bool crosses(const EdgePoints& edge, const TrianglePoints& face) {
  bool used_exact = false;
  return edge_crosses_face(edge, face, used_exact);
}

/// Each point that an edge and a face share has one name: a pair of a vertex and the face or of two edges at
/// distance 0, or a crossing. On a small lattice, most cases are degenerate.
TEST(EdgeFaceCrossing, NamesWhatNoOtherPairNames) {
  RandomNumbers random(11);
  int crossings = 0, others = 0;
  for (int round = 0; round < 6000; ++round) {
    const int size = round % 2 == 0 ? 1 : 3;
    const double scale = std::ldexp(1, 100 * random.between(-9, 9));
    EdgePoints edge{lattice_point(random, size), lattice_point(random, size)};
    TrianglePoints face{lattice_point(random, size), lattice_point(random, size),
                        lattice_point(random, size)};
    const bool expected = cross_by_algebra(edge, face);
    for (Vec3d& p : edge) p *= scale;
    for (Vec3d& p : face) p *= scale;
    EXPECT_EQ(crosses(edge, face), expected);
    bool is_near = point_triangle_distance(edge[0], face, 0) || point_triangle_distance(edge[1], face, 0);
    for (std::size_t i = 0; i < 3; ++i)
      is_near = is_near || edge_edge_distance(edge, {face[i], face[(i + 1) % 3]}, 0);
    EXPECT_FALSE(expected && is_near);
    EXPECT_EQ(expected || is_near, triangles_intersect({edge[0], edge[1], edge[1]}, face));
    crossings += expected;
    others += is_near;
  }
  EXPECT_GT(crossings, 100);
  EXPECT_GT(others, 100);
}

/// Through a point of the face that is exactly inside, on an edge or at a corner, or next to it.
TEST(EdgeFaceCrossing, DecidesNextToTheBorderExactly) {
  const TrianglePoints face{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};
  constexpr double step = 0x1p-80;
  const auto crosses_at = [&](double x, double y) {
    return crosses({Vec3d{x, y, -1}, Vec3d{x, y, 1}}, face);
  };
  EXPECT_TRUE(crosses_at(0.25, 0.25));
  EXPECT_FALSE(crosses_at(0.5, 0));
  EXPECT_TRUE(crosses_at(0.5, step));
  EXPECT_FALSE(crosses_at(0.5, -step));
  EXPECT_FALSE(crosses_at(0.5, 0.5));
  EXPECT_TRUE(crosses_at(0.5, 0.5 - 0x1p-53));
  EXPECT_FALSE(crosses_at(0, 0));
  EXPECT_TRUE(crosses_at(step, step));
  EXPECT_FALSE(crosses({Vec3d{0.25, 0.25, 0}, Vec3d{0.25, 0.25, 1}}, face)) << "its end is on the face";
  EXPECT_TRUE(crosses({Vec3d{0.25, 0.25, -step}, Vec3d{0.25, 0.25, 1}}, face));
  EXPECT_FALSE(crosses({Vec3d{-1, 0.25, 0}, Vec3d{1, 0.25, 0}}, face)) << "in its plane";
  EXPECT_FALSE(crosses({Vec3d{0.25, 0.25, 0}, Vec3d{0.25, 0.25, 0}}, face));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(crosses({Vec3d{0.25, 0.25, -1}, Vec3d{0.25, nan, 1}}, face));
  EXPECT_FALSE(crosses({Vec3d{0.25, 0.25, -1}, Vec3d{0.25, 0.25, INFINITY}}, face));
}

/// Also for slivers, and far from the origin, where floating point has no accurate volumes.
TEST(EdgeFaceCrossing, HasWeightsAndANormal) {
  RandomNumbers random(12);
  int crossings = 0;
  for (int round = 0; round < 20000; ++round) {
    const Vec3d far = round % 4 == 0 ? random.vector(1e6) : Vec3d{};
    const double flatness = round % 3 == 0 ? 1e-13 : 1;
    EdgePoints edge{far + random.vector(1), far + random.vector(1)};
    TrianglePoints face{far + random.vector(1), far + random.vector(1), far + random.vector(1)};
    for (Vec3d& p : face) p.x = far.x + flatness * (p.x - far.x);
    if (!crosses(edge, face)) continue;
    ++crossings;
    bool used_exact = false;
    const EdgeFaceCrossing found = crossing_of(edge, face, used_exact);
    Vec3d on_edge{}, on_face{};
    double of_edge = 0, of_face = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      on_edge += found.on_edge[i] * (edge[i] - far);
      of_edge += found.on_edge[i];
      EXPECT_GT(found.on_edge[i], 0);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      on_face += found.on_face[i] * (face[i] - far);
      of_face += found.on_face[i];
      EXPECT_GT(found.on_face[i], 0);
    }
    EXPECT_NEAR(of_edge, 1, 1e-13);
    EXPECT_NEAR(of_face, 1, 1e-13);
    EXPECT_LT(largest_magnitude(on_edge - on_face), 1e-12);
    EXPECT_LT(largest_magnitude(on_edge - (found.point - far)), 1e-9);
    EXPECT_NEAR(norm(found.normal), 1, 1e-15);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(dot(found.normal, face[i] - face[0]), 0, 1e-12) << flatness;
  }
  EXPECT_GT(crossings, 500);
}

}  // namespace supple::edge_face_crossing_test
