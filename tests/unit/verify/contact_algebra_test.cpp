#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <vector>

#include "supple/continuous.hpp"
#include "supple/error.hpp"
#include "support/soups.hpp"
#include "unit/contact/rational_motion.hpp"

namespace supple {

static void PrintTo(const TimeBracket& bracket, std::ostream* stream) {
  *stream << std::hexfloat << '[' << bracket.low << ", " << bracket.high << ']';
}

namespace contact_algebra_test {

using truth::Rational;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

using Points = std::array<Vec3d, 4>;
using Answer = std::optional<TimeBracket>;

constexpr Answer never = std::nullopt;
Answer exactly(double time) {
  return TimeBracket{time, time};
}
Answer between(double low) {
  return TimeBracket{low, std::nextafter(low, 2.0)};
}

/// The bracket of neighbouring doubles around a rational time.
Answer around(const Rational& time) {
  double low = time.convert_to<double>();
  if (Rational(low) > time) low = std::nextafter(low, -1.0);
  if (Rational(std::nextafter(low, 2.0)) <= time) low = std::nextafter(low, 2.0);
  return Rational(low) == time ? exactly(low) : between(low);
}

Answer vertex_face(const Points& start, const Points& end, double separation = 0) {
  return first_contact_by_algebra(VertexFaceMotion{start, end}, separation);
}
Answer edge_edge(const Points& start, const Points& end, double separation = 0) {
  return first_contact_by_algebra(EdgeEdgeMotion{start, end}, separation);
}

/// The vertex moves on a straight path; the face is at rest.
Answer vertex_on_face(Vec3d from, Vec3d to, const std::array<Vec3d, 3>& face, double separation = 0) {
  return vertex_face({from, face[0], face[1], face[2]}, {to, face[0], face[1], face[2]}, separation);
}

/// Edge a moves by `path`; edge b is at rest.
Answer edge_on_edge(const std::array<Vec3d, 2>& a, Vec3d path, const std::array<Vec3d, 2>& b,
                    double separation = 0) {
  return edge_edge({a[0], a[1], b[0], b[1]}, {a[0] + path, a[1] + path, b[0], b[1]}, separation);
}

constexpr std::array<Vec3d, 3> flat_face = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

TEST(ContactAlgebra, VertexFallsOnFace) {
  EXPECT_EQ(vertex_on_face({1, 1, 1}, {1, 1, -1}, flat_face), exactly(0.5));
  EXPECT_EQ(vertex_on_face({1, 1, 1}, {1, 1, -2}, flat_face), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({1, 1, 1}, {1, 1, 0}, flat_face), exactly(1));
  EXPECT_EQ(vertex_on_face({1, 1, 0}, {1, 1, 1}, flat_face), exactly(0));
  EXPECT_EQ(vertex_on_face({1, 1, 1}, {1, 1, smallest}, flat_face), never);
  EXPECT_EQ(vertex_on_face({3, 3, 1}, {3, 3, -1}, flat_face), never);
  EXPECT_EQ(vertex_on_face({-1, 1, 1}, {-1, 1, -1}, flat_face), never);
}

TEST(ContactAlgebra, VertexFallsOnTheFacesBoundary) {
  EXPECT_EQ(vertex_on_face({2, 2, 1}, {2, 2, -1}, flat_face), exactly(0.5));
  EXPECT_EQ(vertex_on_face({2, 0, 1}, {2, 0, -2}, flat_face), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({0, 0, 1}, {0, 0, -2}, flat_face), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({4, 0, 1}, {4, 0, -2}, flat_face), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({2, -smallest, 1}, {2, -smallest, -2}, flat_face), never);
}

TEST(ContactAlgebra, VertexSlidesInTheFacesPlane) {
  EXPECT_EQ(vertex_on_face({-1, 1, 0}, {2, 1, 0}, flat_face), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({-1, 0, 0}, {2, 0, 0}, flat_face), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({5, 0, 0}, {3, 0, 0}, flat_face), exactly(0.5));
  EXPECT_EQ(vertex_on_face({-1, 1, 0}, {1, -1, 0}, flat_face), exactly(0.5));
  EXPECT_EQ(vertex_on_face({-1, 0.5, 0}, {0.5, -1, 0}, flat_face), never);
  EXPECT_EQ(vertex_on_face({1, 1, 0}, {2, 1, 0}, flat_face), exactly(0));
}

TEST(ContactAlgebra, FaceCollapsed) {
  const std::array<Vec3d, 3> segment = {{{0, 0, 0}, {4, 0, 0}, {1, 0, 0}}}, point = {};
  EXPECT_EQ(vertex_on_face({2, 0, 1}, {2, 0, -2}, segment), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({2, 1, 1}, {2, -2, -2}, segment), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({5, 1, 1}, {5, -2, -2}, segment), never);
  EXPECT_EQ(vertex_on_face({5, 0, 0}, {2, 0, 0}, segment), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({1, 2, 1}, {-2, -4, -2}, point), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({1, 2, 1}, {-2, -4, -1}, point), never);
  EXPECT_EQ(vertex_on_face({}, {}, point), exactly(0));
}

TEST(ContactAlgebra, FaceCollapsesAtTheMomentOfContact) {
  // The face shrinks to a segment at t = 1/2, when the vertex passes it.
  const Points start = {{{1, 0, 1}, {0, 0, 0}, {4, 0, 0}, {1, 2, 0}}};
  const Points end = {{{1, 0, -1}, {0, 0, 0}, {4, 0, 0}, {1, -2, 0}}};
  EXPECT_EQ(vertex_face(start, end), exactly(0.5));
  Points beside = start, beside_end = end;
  beside[0].x = beside_end[0].x = 5;
  EXPECT_EQ(vertex_face(beside, beside_end), never);
  // The face shrinks to a point.
  const Points triangle = {{{0, 0, 3}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}};
  const Points inverted = {{{0, 0, -3}, {-1, 0, 0}, {1, -1, 0}, {1, 1, 0}}};
  EXPECT_EQ(vertex_face(triangle, inverted), exactly(0.5));
}

TEST(ContactAlgebra, NothingMoves) {
  EXPECT_EQ(vertex_on_face({1, 1, 0}, {1, 1, 0}, flat_face), exactly(0));
  EXPECT_EQ(vertex_on_face({1, 1, 1}, {1, 1, 1}, flat_face), never);
  EXPECT_EQ(vertex_on_face({1, 1, 1}, {1, 1, 1}, flat_face, 1), exactly(0));
  EXPECT_EQ(vertex_on_face({5, 5, 0}, {5, 5, 0}, flat_face), never);
  EXPECT_EQ(edge_on_edge({{{0, 0, 0}, {2, 2, 0}}}, {}, {{{0, 2, 0}, {2, 0, 0}}}), exactly(0));
  EXPECT_EQ(edge_on_edge({{{0, 0, 0}, {1, 1, 0}}}, {}, {{{1, 2, 0}, {2, 0, 0}}}), never);
}

TEST(ContactAlgebra, EdgesCross) {
  const std::array<Vec3d, 2> a = {{{-1, 0, 1}, {1, 0, 1}}}, b = {{{0, -1, 0}, {0, 1, 0}}};
  EXPECT_EQ(edge_on_edge(a, {0, 0, -2}, b), exactly(0.5));
  EXPECT_EQ(edge_on_edge(a, {0, 0, -3}, b), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge(a, {0, 0, -0.5}, b), never);
  EXPECT_EQ(edge_on_edge({{{1, 0, 1}, {2, 0, 1}}}, {0, 0, -3}, b), never);
  // An end point meets the interior of an edge, then an end point meets an end point.
  EXPECT_EQ(edge_on_edge({{{0, 0, 1}, {2, 0, 1}}}, {0, 0, -3}, b), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge({{{0, 1, 1}, {2, 3, 1}}}, {0, 0, -3}, b), around(Rational(1, 3)));
}

TEST(ContactAlgebra, ParallelEdges) {
  const std::array<Vec3d, 2> b = {{{0, 0, 0}, {0, 1, 0}}};
  EXPECT_EQ(edge_on_edge({{{0, 0.5, 1}, {0, 3, 1}}}, {0, 0, -3}, b), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge({{{0, 2, 1}, {0, 3, 1}}}, {0, 0, -3}, b), never);
  EXPECT_EQ(edge_on_edge({{{0, 2, 0}, {0, 3, 0}}}, {0, -3, 0}, b), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge({{{1, 0, 0}, {1, 1, 0}}}, {-3, 0, 0}, b), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge({{{1, 0, 0}, {1, 1, 0}}}, {-3, 6, 0}, b), never);
}

TEST(ContactAlgebra, EdgesWithoutLength) {
  EXPECT_EQ(edge_on_edge({{{1, 1, 1}, {1, 1, 1}}}, {-3, -3, -3}, {}), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge({{{1, 1, 1}, {1, 1, 1}}}, {-3, -3, -2}, {}), never);
  EXPECT_EQ(edge_on_edge({{{1, 1, 1}, {1, 1, 1}}}, {0, 0, -3}, {{{0, 0, 0}, {2, 2, 0}}}),
            around(Rational(1, 3)));
}

/// The plane z = x s / 9 with s = 1 - 2 t, and a vertex at (9 s, y, z): it is z - s² above the plane.
Answer near_turning_plane(double y, double z, Vec3d corner_start, Vec3d corner_end) {
  return vertex_face({{{9, y, z}, {-9, 0, -1}, corner_start, {0, 9, 0}}},
                     {{{-9, y, z}, {-9, 0, 1}, corner_end, {0, 9, 0}}});
}

TEST(ContactAlgebra, GrazesWithoutCrossing) {
  const auto graze = [](double y, double z) { return near_turning_plane(y, z, {9, 0, 1}, {9, 0, -1}); };
  for (const double y : {0.0, 1.0, 9.0}) EXPECT_EQ(graze(y, 0), exactly(0.5)) << y;
  EXPECT_EQ(graze(10, 0), never);
  EXPECT_EQ(graze(1, -smallest), never);
  EXPECT_EQ(graze(1, 0x1p-60), exactly(0.5 - 0x1p-31));
  EXPECT_EQ(graze(1, 0x1p-200), between(std::nextafter(0.5, 0)));
}

TEST(ContactAlgebra, PassesThePlaneBesideTheFaceFirst) {
  EXPECT_EQ(near_turning_plane(1, 0.25, {9, 0, 1}, {9, 0, -1}), exactly(0.25));
  EXPECT_EQ(near_turning_plane(1, 0.25, {0, 0, 0}, {0, 0, 0}), exactly(0.75));
}

TEST(ContactAlgebra, FaceMovesToo) {
  EXPECT_EQ(vertex_face({{{0, 0, 1}, {-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}},
                        {{{0, 0, -1}, {-9, -9, -1}, {9, -9, -1}, {0, 9, -1}}}),
            exactly(1));
  EXPECT_EQ(vertex_face({{{0, 0, 1}, {-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}},
                        {{{0, 0, 0}, {-9, -9, 2}, {9, -9, 2}, {0, 9, 2}}}),
            around(Rational(1, 3)));
}

TEST(ContactAlgebra, WithinASeparationOfAFace) {
  EXPECT_EQ(vertex_on_face({1, 1, 2}, {1, 1, 0}, flat_face, 0.5), exactly(0.75));
  EXPECT_EQ(vertex_on_face({1, 1, -2}, {1, 1, 1}, flat_face, 1), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({1, 1, 2}, {1, 1, 0.5}, flat_face, 0.5), exactly(1));
  EXPECT_EQ(vertex_on_face({1, 1, 2}, {1, 1, 0.5}, flat_face, std::nextafter(0.5, 0)), never);
  EXPECT_EQ(vertex_on_face({1, 1, 0.5}, {1, 1, 2}, flat_face, 0.5), exactly(0));
}

TEST(ContactAlgebra, WithinASeparationOfAnEdgeOrVertex) {
  // The nearest feature is the edge y = 0 (beside it, then diagonally below it), then the origin's vertex.
  EXPECT_EQ(vertex_on_face({1, -2, 0}, {1, 0, 0}, flat_face, 0.5), exactly(0.75));
  EXPECT_EQ(vertex_on_face({1, -5, 0}, {1, 4, 0}, flat_face, 2), around(Rational(1, 3)));
  EXPECT_EQ(vertex_on_face({1, -3, -4}, {1, -3, 5}, flat_face, 3), around(Rational(4, 9)));
  EXPECT_EQ(vertex_on_face({-3, -4, -5}, {-3, -4, 5}, flat_face, 5), exactly(0.5));
  EXPECT_EQ(vertex_on_face({-3, -4, -5}, {-3, -4, 5}, flat_face, std::nextafter(5, 0)), never);
  EXPECT_EQ(vertex_on_face({-9, 0, 0}, {0, 0, 0}, flat_face, 3), around(Rational(2, 3)));
  EXPECT_EQ(vertex_on_face({13, 0, 0}, {4, 0, 0}, flat_face, 3), around(Rational(2, 3)));
}

TEST(ContactAlgebra, IrrationalTime) {
  // The vertex reaches the separation when √2 (1 - t) = 1.
  const Answer found = vertex_on_face({-1, -1, 0}, {0, 0, 0}, flat_face, 1);
  ASSERT_TRUE(found);
  const auto two_squares = [](double t) { return Rational(2) * (1 - Rational(t)) * (1 - Rational(t)); };
  EXPECT_GT(two_squares(found->low), 1);
  EXPECT_LT(two_squares(found->high), 1);
  EXPECT_EQ(found->high, std::nextafter(found->low, 1.0));
}

TEST(ContactAlgebra, EdgesWithinASeparation) {
  const std::array<Vec3d, 2> a = {{{-1, 0, 1}, {1, 0, 1}}}, b = {{{0, -1, 0}, {0, 1, 0}}};
  EXPECT_EQ(edge_on_edge(a, {0, 0, -2}, b, 0.25), exactly(0.375));
  EXPECT_EQ(edge_on_edge(a, {0, 0, -2.25}, b, 0.25), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge(a, {}, b, 1), exactly(0));
  EXPECT_EQ(edge_on_edge(a, {}, b, std::nextafter(1, 0)), never);
  // End point near an edge, end point near an end point, parallel edges, collinear edges.
  EXPECT_EQ(edge_on_edge({{{4, 0, 0}, {6, 0, 0}}}, {-9, 0, 0}, b, 1), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge({{{4, 4, 8}, {6, 4, 8}}}, {0, 0, -8}, b, 5), exactly(1));
  EXPECT_EQ(edge_on_edge({{{4, -1, 0}, {4, 1, 0}}}, {-9, 0, 0}, b, 1), around(Rational(1, 3)));
  EXPECT_EQ(edge_on_edge({{{0, 5, 0}, {0, 6, 0}}}, {0, -9, 0}, b, 1), around(Rational(1, 3)));
}

TEST(ContactAlgebra, CoordinatesFarApartInSize) {
  const auto fall = [](double from, double to) {
    return vertex_on_face({1, 1, from}, {1, 1, to}, flat_face);
  };
  EXPECT_EQ(fall(1e300, -1e-300), between(std::nextafter(1, 0)));
  EXPECT_EQ(fall(1e-300, -1e300), between(0));
  EXPECT_EQ(fall(1e300, -1e300), exactly(0.5));
  EXPECT_EQ(fall(smallest, -smallest), exactly(0.5));
  EXPECT_EQ(fall(1e300, 1e-300), never);
  EXPECT_EQ(fall(1e300, 0), exactly(1));
  EXPECT_EQ(fall(smallest, -1), between(0));
  const std::array<Vec3d, 3> huge = {{{-1e308, -1e308, 0}, {1e308, -1e308, 0}, {0, 1e308, 0}}};
  EXPECT_EQ(vertex_on_face({smallest, 0, 1}, {1, smallest, -1}, huge), exactly(0.5));
  EXPECT_EQ(vertex_on_face({smallest, 0, 1e-300}, {1, smallest, -1e300}, huge), between(0));
  EXPECT_EQ(vertex_on_face({0, 0, 1}, {0, 0, -1}, huge, smallest), between(std::nextafter(0.5, 0)));
}

TEST(ContactAlgebra, RejectsNothingForWhatRoundingDoes) {
  // If the face were rounded down to multiples of 2^-55, it would lie below the end position of the vertex.
  // That position is below the true face.
  constexpr double eighth = 0x1p-58;
  EXPECT_EQ(vertex_on_face({0, 0, 1}, {0, 0, 0}, {{{-1, -1, -eighth}, {-1, 1, -eighth}, {1, 0, 7 * eighth}}}),
            between(std::nextafter(1, 0)));
}

TEST(ContactAlgebra, NotFiniteTouchesNothing) {
  for (const double value : {infinity, -infinity, std::nan("")}) {
    EXPECT_EQ(vertex_on_face({1, 1, value}, {1, 1, -1}, flat_face), never);
    EXPECT_EQ(vertex_on_face({1, 1, 1}, {1, value, -1}, flat_face, 100), never);
    EXPECT_EQ(edge_on_edge({{{0, 0, 0}, {2, 2, 0}}}, {}, {{{0, 2, 0}, {2, value, 0}}}), never);
  }
}

TEST(ContactAlgebra, RefusesSeparation) {
  for (const double value : {infinity, -infinity, std::nan(""), -1.0, -smallest}) {
    EXPECT_THROW(vertex_on_face({1, 1, 1}, {1, 1, -1}, flat_face, value), Error);
    EXPECT_THROW(edge_on_edge({}, {}, {}, value), Error);
  }
  EXPECT_EQ(vertex_on_face({1, 1, 1}, {1, 1, -1}, flat_face, -0.0), exactly(0.5));
}

/// Compares the bracket with exact rational geometry at sampled times.
template <class Motion>
Answer answer_that_agrees_with_samples(const Motion& motion, double separation, int samples) {
  const Answer found = first_contact_by_algebra(motion, separation);
  const Rational limit = Rational(separation) * Rational(separation);
  const auto near = [&](const Rational& time) { return truth::squared_distance_at(motion, time) <= limit; };
  for (int k = 0; k <= samples; ++k) {
    const Rational time(k, samples);
    if (found && (time > Rational(found->low) || time == Rational(found->high))) break;
    EXPECT_FALSE(near(time)) << "at " << time;
  }
  if (found && found->low == found->high) {
    EXPECT_TRUE(near(Rational(found->low))) << found->low;
  } else if (found) {
    EXPECT_EQ(found->high, std::nextafter(found->low, 2.0));
    EXPECT_FALSE(near(Rational(found->low)));
  }
  return found;
}

/// Checks coordinates of moderate size in the same way. Returns true if there is a contact.
template <class Motion>
bool agrees_with_samples(const Motion& motion, double separation) {
  const Answer found = answer_that_agrees_with_samples(motion, separation, 12);
  if (!found) return false;
  const Rational limit = Rational(separation) * Rational(separation);
  EXPECT_LE(truth::squared_distance_at(motion, Rational(found->high)), limit + Rational(1e-12));
  return true;
}

template <class Motion>
Motion random_motion(RandomNumbers& random, std::uint32_t steps, double scale) {
  Motion motion;
  for (Points* points : {&motion.start, &motion.end}) {
    for (Vec3d& p : *points) {
      for (int axis = 0; axis < 3; ++axis) {
        p[axis] = scale * (random.below(2 * steps + 1) - static_cast<double>(steps));
      }
    }
  }
  return motion;
}

TEST(ContactAlgebra, AgreesWithRationalGeometryAtSampledTimes) {
  RandomNumbers random(5);
  for (const double separation : {0.0, 0.25, 1.0}) {
    int vertex_face_contacts = 0, edge_edge_contacts = 0;
    for (int i = 0; i < 150; ++i) {
      const std::uint32_t steps = 1 + random.below(3);
      const auto vf = random_motion<VertexFaceMotion>(random, steps, 1);
      vertex_face_contacts += agrees_with_samples(vf, separation);
      const auto ee = random_motion<EdgeEdgeMotion>(random, steps, 1);
      edge_edge_contacts += agrees_with_samples(ee, separation);
      if (HasFailure()) FAIL() << "query " << i << ", separation " << separation;
    }
    EXPECT_GT(vertex_face_contacts, 20);
    EXPECT_LT(vertex_face_contacts, 140);
    EXPECT_GT(edge_edge_contacts, 20);
    EXPECT_LT(edge_edge_contacts, 140);
  }
}

TEST(ContactAlgebra, AgreesWithRationalGeometryInThePlane) {
  RandomNumbers random(6);
  int contacts = 0;
  for (int i = 0; i < 150; ++i) {
    auto vf = random_motion<VertexFaceMotion>(random, 2, 1);
    auto ee = random_motion<EdgeEdgeMotion>(random, 2, 1);
    for (Points* points : {&vf.start, &vf.end, &ee.start, &ee.end}) {
      for (Vec3d& p : *points) p.z = p.x - p.y;
    }
    const double separation = i % 2;
    contacts += agrees_with_samples(vf, separation) + agrees_with_samples(ee, separation);
    if (HasFailure()) FAIL() << "query " << i;
  }
  EXPECT_GT(contacts, 75);
}

TEST(ContactAlgebra, AgreesWithRationalGeometryOnNumbersOfAllSizes) {
  RandomNumbers random(9);
  int contacts = 0;
  for (int i = 0; i < 20; ++i) {
    const int largest_exponent = i % 4 == 0 ? 300 : 100;
    const auto number = [&] {
      const double digits = random.below(4) == 0 ? 0 : random.uniform(-1, 1);
      const auto exponent = static_cast<int>(random.below(static_cast<std::uint32_t>(2 * largest_exponent)));
      return std::ldexp(digits, exponent - largest_exponent);
    };
    VertexFaceMotion vf;
    EdgeEdgeMotion ee;
    for (Points* points : {&vf.start, &vf.end, &ee.start, &ee.end}) {
      for (Vec3d& p : *points) p = {number(), number(), number()};
    }
    const double separation = i % 3 == 0 ? std::fabs(number()) : 0;
    contacts += answer_that_agrees_with_samples(vf, separation, 4).has_value();
    contacts += answer_that_agrees_with_samples(ee, separation, 4).has_value();
    if (HasFailure()) FAIL() << "query " << i;
  }
  EXPECT_GT(contacts, 8);
}

template <class Motion>
Motion permuted(const Motion& motion, const std::array<std::size_t, 4>& order) {
  Motion result;
  for (std::size_t i = 0; i < 4; ++i) {
    result.start[i] = motion.start[order[i]];
    result.end[i] = motion.end[order[i]];
  }
  return result;
}

template <class Motion, class Change>
Motion changed(Motion motion, Change change) {
  for (Points* points : {&motion.start, &motion.end}) {
    for (Vec3d& p : *points) p = change(p);
  }
  return motion;
}

template <class Motion>
void expect_symmetric(const Motion& motion, double separation,
                      const std::vector<std::array<std::size_t, 4>>& orders) {
  const Answer expected = first_contact_by_algebra(motion, separation);
  for (const auto& order : orders) {
    EXPECT_EQ(first_contact_by_algebra(permuted(motion, order), separation), expected);
  }
  const auto expect_unchanged = [&](auto change, double factor) {
    EXPECT_EQ(first_contact_by_algebra(changed(motion, change), factor * separation), expected);
  };
  expect_unchanged([](Vec3d p) { return Vec3d{p.y, p.z, p.x}; }, 1);
  expect_unchanged([](Vec3d p) { return Vec3d{p.y, p.x, p.z}; }, 1);
  expect_unchanged([](Vec3d p) { return Vec3d{-p.x, p.y, -p.z}; }, 1);
  expect_unchanged([](Vec3d p) { return p * -1.0; }, 1);
  expect_unchanged([](Vec3d p) { return p * 0x1p-600; }, 0x1p-600);
  expect_unchanged([](Vec3d p) { return p * 0x1p+900; }, 0x1p+900);
}

TEST(ContactAlgebra, Symmetries) {
  RandomNumbers random(7);
  for (int i = 0; i < 120; ++i) {
    // Small integers, values with the precision of floats, then of doubles.
    const std::uint32_t steps = i % 3 == 0 ? 2 : i % 3 == 1 ? 1u << 24 : 1u << 31;
    const double scale = 2.0 / steps * (i % 3 == 2 ? 1 + 0x1p-20 : 1), separation = i % 2 * scale * steps / 8;
    expect_symmetric(random_motion<VertexFaceMotion>(random, steps, scale), separation,
                     {{0, 2, 3, 1}, {0, 3, 1, 2}, {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 3, 2, 1}});
    expect_symmetric(random_motion<EdgeEdgeMotion>(random, steps, scale), separation,
                     {{1, 0, 2, 3}, {0, 1, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}});
  }
}

TEST(ContactAlgebra, NeedsNoMoreThanTheCoordinatesAreWide) {
  // The scaled motion gets a tiny offset, which makes its coordinates too wide for the quick rejection with
  // narrow integers. The time must stay the same.
  RandomNumbers random(8);
  int contacts = 0;
  for (int i = 0; i < 300; ++i) {
    auto motion = random_motion<VertexFaceMotion>(random, 1u << 20, 0x1p-20);
    const Answer narrow = first_contact_by_algebra(motion);
    motion = changed(motion, [](Vec3d p) { return p * 0x1p-300; });
    motion.start[0].x += smallest;
    const Answer wide = first_contact_by_algebra(motion);
    ASSERT_EQ(narrow.has_value(), wide.has_value());
    if (!narrow) continue;
    ++contacts;
    EXPECT_NEAR(narrow->low, wide->low, 1e-15);
  }
  EXPECT_GT(contacts, 20);
}

}  // namespace contact_algebra_test
}  // namespace supple
