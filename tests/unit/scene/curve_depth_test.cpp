// The depth of a curve against the smallest move that separates two convex bodies, by rationals.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/random.hpp"

namespace supple::curve_depth_test {

using Rational = boost::multiprecision::cpp_rational;
using RationalVector = std::array<Rational, 3>;

constexpr SceneOptions penetration{.contacts = ContactKinds::penetration, .curves = true};

RationalVector rational(const Vec3d& v) {
  return {Rational(v.x), Rational(v.y), Rational(v.z)};
}
Rational dot(const RationalVector& a, const RationalVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
RationalVector cross(const RationalVector& a, const RationalVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A box whose faces have n x n squares: its edges along three axes, all numbers exact.
struct Box {
  Vec3d center;
  std::array<Vec3d, 3> half;  // vectors from the middle to three faces
  std::uint32_t divisions = 1;

  TriangleMesh mesh() const {
    TriangleMesh mesh = make_box({2, 2, 2}, divisions);
    for (Vec3d& p : mesh.positions) p = center + p.x * half[0] + p.y * half[1] + p.z * half[2];
    return mesh;
  }
  /// The largest and the smallest value of a linear function.
  std::pair<Rational, Rational> range(const RationalVector& m) const {
    Rational radius = 0;
    for (const Vec3d& h : half) radius += abs(dot(m, rational(h)));
    const Rational middle = dot(m, rational(center));
    return {middle - radius, middle + radius};
  }
};

/// The smallest move of a along n after which the insides of a and b have no common point and will have none.
/// The boxes overlap exactly when they do along the normals of the faces and across each two edges.
Rational separating_move(const Box& a, const Box& b, const Vec3d& n) {
  std::vector<RationalVector> directions;
  for (std::size_t i = 0; i < 3; ++i) {
    directions.push_back(cross(rational(a.half[i]), rational(a.half[(i + 1) % 3])));
    directions.push_back(cross(rational(b.half[i]), rational(b.half[(i + 1) % 3])));
    for (std::size_t k = 0; k < 3; ++k) directions.push_back(cross(rational(a.half[i]), rational(b.half[k])));
  }
  std::optional<Rational> least;
  for (RationalVector m : directions) {
    Rational along = dot(m, rational(n));
    if (along == 0) continue;
    if (along < 0) {
      for (Rational& x : m) x = -x;
      along = -along;
    }
    const Rational move = (b.range(m).second - a.range(m).first) / along;
    if (!least || move < *least) least = move;
  }
  return std::max(*least, Rational(0));
}

std::vector<IntersectionCurve> curves_of(const TriangleMesh& a, const TriangleMesh& b) {
  Scene scene(penetration);
  scene.add(a, {.solid = true});
  scene.add(b, {.solid = true});
  const auto curves = scene.detect().curves;
  return {curves.begin(), curves.end()};
}

void expect_near(const Vec3d& found, const Vec3d& expected, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[axis], expected[axis], tolerance) << axis;
}

/// Expects that the depth is the smallest move along the normal that separates the boxes.
void expect_separation(const Box& a, const Box& b, const IntersectionCurve& curve) {
  EXPECT_NEAR(norm(curve.normal), 1, 1e-14);
  const double size = norm(a.half[0]) + norm(a.half[1]) + norm(a.half[2]);
  const double exact_move = separating_move(a, b, curve.normal).convert_to<double>();
  EXPECT_NEAR(curve.depth, exact_move, 1e-12 * exact_move + 1e-13 * size);
}

TEST(CurveDepth, OfFlushBoxes) {
  for (const double shift : {0.0, 1.0}) {
    const Box a{{0, 0, 0}, {{{64, 0, 0}, {0, 32, 0}, {0, 0, 16}}}},
        b{{0, 63.96875, shift}, {{{64, 0, 0}, {0, 32.03125, 0}, {0, 0, 16}}}};
    for (const std::uint32_t divisions : {1u, 4u}) {
      Box fine_a = a, fine_b = b;
      fine_a.divisions = divisions;
      fine_b.divisions = 2 * divisions;
      const auto curves = curves_of(fine_a.mesh(), fine_b.mesh());
      ASSERT_EQ(curves.size(), 1u);
      EXPECT_EQ(curves[0].kind, CurveKind::branched);
      EXPECT_EQ(curves[0].normal, (Vec3d{0, -1, 0}));
      EXPECT_EQ(curves[0].depth, 0.0625);
      const auto swapped = curves_of(fine_b.mesh(), fine_a.mesh());
      EXPECT_EQ(swapped[0].normal, (Vec3d{0, 1, 0}));
      EXPECT_EQ(swapped[0].depth, 0.0625);
    }
  }
}

/// Each flush face has a curve of its own, and no vertex is inside.
TEST(CurveDepth, OfABoxAsThickAsTheSlabAroundIt) {
  for (const double offset : {-0.1, -0x1p-20, 0.0, 0x1p-20, 0.01}) {
    Scene scene({.contacts = ContactKinds::penetration, .curves = true});
    scene.add(make_box({1, 0.125, 1}, 1), {.solid = true});
    TriangleMesh box = make_box({0.5, 0.125, 0.5}, 1);
    for (Vec3d& p : box.positions)
      p.x += 0.25 + offset;  // within the slab, flush on a third side, or beyond it
    scene.add(box, {.solid = true});
    const DetectResult& result = scene.detect();
    ASSERT_GT(result.curves.size(), 0u);
    for (const IntersectionCurve& curve : result.curves) {
      EXPECT_DOUBLE_EQ(curve.depth, 0.125) << offset;
      EXPECT_DOUBLE_EQ(std::fabs(curve.normal.y), 1);
    }
  }
}

TEST(CurveDepth, OfABoxInACorner) {
  const Box a{{0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  const Box b{{1.875, 1.75, -1.625}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  const auto curves = curves_of(a.mesh(), b.mesh());
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].normal, (Vec3d{-1, 0, 0}));
  EXPECT_EQ(curves[0].depth, 0.125);
  // Three equal ways out: one of them, which is no longer than in a corner that is not quite symmetric.
  const Box c{{1.875, 1.875, -1.875}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  const auto equal = curves_of(a.mesh(), c.mesh());
  ASSERT_EQ(equal.size(), 1u);
  EXPECT_EQ(equal[0].normal, (Vec3d{-1, 0, 0}));
  EXPECT_EQ(equal[0].depth, 0.125);
}

TEST(CurveDepth, IsZeroWhereBoxesOnlyTouch) {
  const Box below{{0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  for (const Vec3d& place : {Vec3d{0, 2, 0}, Vec3d{0.5, 2, 0.25}, Vec3d{1, 2, 1}}) {
    const Box above{place, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    const auto curves = curves_of(above.mesh(), below.mesh());
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(curves[0].normal, (Vec3d{0, 1, 0}));
    EXPECT_EQ(curves[0].depth, 0);
  }
}

/// The faces that the plate pierces have nothing ahead along its normal, but its edges inside the box have.
/// Rounding moves vertices of flush faces in front of and behind the other face.
TEST(CurveDepth, IsRoundingWhereTurnedBoxesOnlyTouch) {
  const std::array<Vec3d, 3> axes{
      {{2. / 3, 2. / 3, 1. / 3}, {-2. / 3, 1. / 3, 2. / 3}, {1. / 3, -2. / 3, 2. / 3}}};
  const Box below{{0, 0, 0}, axes, 8}, above{axes[2] + axes[2], axes, 8};
  const auto curves = curves_of(above.mesh(), below.mesh());
  ASSERT_GT(curves.size(), 0u);
  for (const IntersectionCurve& curve : curves) {
    EXPECT_LE(curve.depth, 0x1p-48);
    expect_near(curve.normal, axes[2], 0x1p-40);
  }
}

TEST(CurveDepth, OfAPlateThroughABoxIsAcrossThePlate) {
  const Box box{{0.5, 0.5, 0.5}, {{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}}};
  for (const double thickness : {1e-3, 1e-5, 1e-6, 1e-7, 1e-9}) {
    SCOPED_TRACE(thickness);
    const Box plate{{0.5, 0.5, 0.5}, {{{1, 0, 0}, {0, 0.25, 0}, {0, 0, thickness / 2}}}};
    const auto curves = curves_of(box.mesh(), plate.mesh());
    ASSERT_EQ(curves.size(), 2u);
    for (const IntersectionCurve& curve : curves) {
      EXPECT_NEAR(std::fabs(curve.normal.z), 1, 1e-12);
      EXPECT_NEAR(curve.depth, 0.5 + thickness / 2, 1e-9);
    }
  }
}

/// A peg fits exactly between two walls and is too deep in the ground.
TEST(CurveDepth, LeavesOutSidesThatSlide) {
  // The walls and the ground are one body: an outline in the x-y plane, extruded along z.
  const std::vector<Vec3d> outline{{-3, -2, 0}, {3, -2, 0}, {3, 2, 0},  {1, 2, 0},
                                   {1, 0, 0},   {-1, 0, 0}, {-1, 2, 0}, {-3, 2, 0}};
  TriangleMesh slot;
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (const double z : {-1.0, 1.0}) {
    for (const Vec3d& p : outline) slot.positions.push_back({p.x, p.y, z});
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t k = (i + 1) % count;
    slot.triangles.push_back({i, k, k + count});
    slot.triangles.push_back({i, k + count, i + count});
  }
  for (const Triangle& t : {Triangle{0, 1, 4}, Triangle{1, 2, 4}, Triangle{2, 3, 4}, Triangle{0, 4, 5},
                            Triangle{0, 5, 7}, Triangle{5, 6, 7}}) {
    slot.triangles.push_back({t[2], t[1], t[0]});
    slot.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  const Box peg{{0, 1.375, 0}, {{{1, 0, 0}, {0, 1.5, 0}, {0, 0, 0.5}}}};
  const auto curves = curves_of(peg.mesh(), slot);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].normal, (Vec3d{0, 1, 0}));
  EXPECT_EQ(curves[0].depth, 0.125);
}

/// Scaled rotations with integer coefficients.
constexpr std::array<std::array<Vec3d, 3>, 4> rotations{{
    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {{{3, 4, 0}, {-4, 3, 0}, {0, 0, 5}}},
    {{{2, 2, 1}, {-2, 1, 2}, {1, -2, 2}}},
    {{{6, 2, 3}, {-3, 6, 2}, {-2, -3, 6}}},
}};

Vec3d turned(const std::array<Vec3d, 3>& rotation, const Vec3d& v) {
  return v.x * rotation[0] + v.y * rotation[1] + v.z * rotation[2];
}

/// Boxes along the same axes, flush where random numbers agree.
std::array<Box, 2> two_boxes(RandomNumbers& random, double scale) {
  const auto& rotation = rotations[random.below(4)];
  std::array<Box, 2> boxes;
  for (Box& box : boxes) {
    box.divisions = 1u << random.below(3);
    for (std::size_t i = 0; i < 3; ++i) {
      const double length = static_cast<double>(random.between(2, 8));
      box.half[i] = length * scale * rotation[i];
    }
  }
  // The least overlap is along one axis, with equal middles or equal sides along the others.
  Vec3d gap;
  const auto axis = static_cast<int>(random.below(3));
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double of_a = norm(boxes[0].half[k]) / norm(scale * rotation[k]),
                 of_b = norm(boxes[1].half[k]) / norm(scale * rotation[k]);
    const double side = random.below(2) == 0 ? 1 : -1;
    if (i == axis)
      gap[i] = side * (std::round(of_a) + std::round(of_b) - 0.0625 * random.between(1, 16));
    else if (random.below(2) == 0)
      gap[i] = side * (std::round(of_a) - std::round(of_b));
  }
  boxes[1].center = scale * turned(rotation, gap);
  return boxes;
}

TEST(CurveDepth, SeparatesBoxesAlongTheSameAxes) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double scale = std::array{1.0, 0x1p300, 0x1p-300}[seed % 3];
    const auto [a, b] = two_boxes(random, scale);
    const auto curves = curves_of(a.mesh(), b.mesh());
    // A box that goes through the other one has a curve where it enters and one where it leaves.
    if (curves.size() != 1) continue;
    expect_separation(a, b, curves[0]);
    // It is the least of all: the boxes have no other directions.
    Rational least = separating_move(a, b, curves[0].normal);
    for (const Vec3d& h : a.half) {
      for (const double sign : {1.0, -1.0})
        least = std::min(least, separating_move(a, b, (sign / norm(h)) * h));
    }
    EXPECT_LE(curves[0].depth, least.convert_to<double>() * (1 + 1e-9));
  }
}

TriangleMesh mirrored(TriangleMesh mesh) {
  for (Vec3d& p : mesh.positions) p.x = -p.x;
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh in_other_order(const TriangleMesh& mesh, RandomNumbers& random) {
  std::vector<std::uint32_t> place(mesh.positions.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
  for (std::uint32_t i = 1; i < place.size(); ++i) std::swap(place[i], place[random.below(i + 1)]);
  TriangleMesh result = mesh;
  for (std::size_t v = 0; v < place.size(); ++v) result.positions[place[v]] = mesh.positions[v];
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t first = random.below(3);
    for (std::size_t k = 0; k < 3; ++k) result.triangles[t][k] = place[mesh.triangles[t][(k + first) % 3]];
  }
  std::reverse(result.triangles.begin(), result.triangles.end());
  return result;
}

TEST(CurveDepth, FollowsTheSymmetriesOfTheInput) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    std::array<TriangleMesh, 2> meshes;
    if (seed % 3 == 0) {
      const auto boxes = two_boxes(random, 1);
      meshes = {boxes[0].mesh(), boxes[1].mesh()};
    } else {
      meshes = {make_icosphere(3), make_icosphere(seed % 3 == 1 ? 4 : 2)};
      for (Vec3d& p : meshes[1].positions) p = p + Vec3d{1.1, 0.3, 0.2} + random.vector(0.25);
    }
    const auto curves = curves_of(meshes[0], meshes[1]);
    if (curves.size() != 1) continue;
    const auto& [normal, depth] = std::pair(curves[0].normal, curves[0].depth);
    const auto expect_same = [&](const std::vector<IntersectionCurve>& others, const Vec3d& expected) {
      ASSERT_EQ(others.size(), 1u);
      expect_near(others[0].normal, expected, 1e-9);
      EXPECT_NEAR(others[0].depth, depth, 1e-9 * (depth + 1));
    };
    expect_same(curves_of(mirrored(meshes[0]), mirrored(meshes[1])), {-normal.x, normal.y, normal.z});
    expect_same(curves_of(meshes[1], meshes[0]), -normal);
    expect_same(curves_of(in_other_order(meshes[0], random), in_other_order(meshes[1], random)), normal);
  }
}

/// Boxes of any directions, and a box and a ball.
TEST(CurveDepth, NeverExceedsWhatSeparates) {
  std::size_t tested = 0, exact_count = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    std::array<Box, 2> boxes;
    for (Box& box : boxes) {
      const auto& rotation = rotations[random.below(4)];
      for (std::size_t i = 0; i < 3; ++i)
        box.half[i] = (static_cast<double>(random.between(2, 8)) / 8) * rotation[i];
    }
    boxes[1].center = {static_cast<double>(random.between(-40, 40)) / 8,
                       static_cast<double>(random.between(-40, 40)) / 8,
                       static_cast<double>(random.between(-40, 40)) / 8};
    const auto curves = curves_of(boxes[0].mesh(), boxes[1].mesh());
    for (const IntersectionCurve& curve : curves) {
      ++tested;
      const double exact_move = separating_move(boxes[0], boxes[1], curve.normal).convert_to<double>();
      EXPECT_LE(curve.depth, exact_move * (1 + 1e-11) + 1e-13);
      exact_count += curves.size() == 1 && curve.depth > exact_move * (1 - 1e-11) - 1e-13 ? 1 : 0;
    }
  }
  EXPECT_GT(tested, 100u);
  RecordProperty("separated", static_cast<int>(exact_count));
  EXPECT_GT(exact_count, tested / 2);
}

TEST(CurveDepth, OfBallsIsTheThicknessOfWhatTheyShare) {
  // The larger side of each ball is behind the curve when they share more than half.
  for (const double offset : {1.75, 1.0, 0.25}) {
    const TriangleMesh ball = make_icosphere(8);
    TriangleMesh other = ball;
    for (Vec3d& p : other.positions) p = p + Vec3d{0, offset, 0};
    const auto curves = curves_of(ball, other);
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_NEAR(curves[0].normal.y, -1, 1e-3);
    EXPECT_NEAR(curves[0].depth, 2 - offset, 0.01);
  }
}

TEST(CurveDepth, OfManyPinsInASheetIsNearlyThatOfEachAlone) {
  TriangleMesh sheet = make_cloth(81, 81, 40, 40);
  for (Vec3d& p : sheet.positions) p.y = 0.2 * std::sin(p.x) * std::cos(0.7 * p.z);
  const auto curves_with = [&](const TriangleMesh& solid) {
    Scene scene(penetration);
    scene.add(sheet);
    scene.add(solid, {.solid = true});
    const auto found = scene.detect().curves;
    return std::vector(found.begin(), found.end());
  };
  TriangleMesh pins;
  std::vector<IntersectionCurve> alone;
  RandomNumbers random(3);
  for (std::uint32_t i = 0; i < 100; ++i) {
    TriangleMesh pin = make_box({0.8, 2, 0.8}, 1);
    const Vec3d middle{4.0 * (i % 10) - 18, random.vector(0.5).y, 4.0 * (i / 10) - 18};
    for (Vec3d& p : pin.positions) p = p + middle + 0.05 * Vec3d{p.y, 0, -p.y};
    const auto curves = curves_with(pin);
    ASSERT_EQ(curves.size(), 1u);
    alone.push_back(curves[0]);
    const auto first = static_cast<std::uint32_t>(pins.positions.size());
    pins.positions.insert(pins.positions.end(), pin.positions.begin(), pin.positions.end());
    for (const Triangle& t : pin.triangles)
      pins.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const auto together = curves_with(pins);
  ASSERT_EQ(together.size(), alone.size());
  for (const IntersectionCurve& curve : together) {
    const auto same = std::ranges::find_if(alone, [&](const IntersectionCurve& other) {
      return std::abs(other.centroid.x - curve.centroid.x) + std::abs(other.centroid.z - curve.centroid.z) <
             1;
    });
    ASSERT_NE(same, alone.end());
    // Alone, the part of the sheet around the pin counts, too.
    EXPECT_LE(curve.depth, same->depth * (1 + 1e-9));
    EXPECT_GE(curve.depth, same->depth * 0.99);
    EXPECT_NEAR(dot(rational(curve.normal), rational(same->normal)).convert_to<double>(), 1, 1e-9);
  }
}

}  // namespace supple::curve_depth_test
