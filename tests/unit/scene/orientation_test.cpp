// Solids that are inside out or mirrored, and holes in solids: their curves are those of outward triangles.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/topology.hpp"
#include "supple/verify.hpp"

namespace supple::orientation_test {

constexpr SceneOptions penetration{.contacts = ContactKinds::penetration, .curves = true};

void turn_over(std::vector<Triangle>& triangles) {
  for (Triangle& triangle : triangles) std::swap(triangle[1], triangle[2]);
}

TriangleMesh inside_out(TriangleMesh mesh) {
  turn_over(mesh.triangles);
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3d& offset) {
  for (Vec3d& p : mesh.positions) p = p + offset;
  return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3d& p : mesh.positions) p = factor * p;
  return mesh;
}

/// Both meshes as one, with their own vertices.
TriangleMesh both(TriangleMesh mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& [v, w, x] : other.triangles) mesh.triangles.push_back({v + first, w + first, x + first});
  return mesh;
}

/// Expects one curve of this depth, along which a leaves b.
void expect_depth(const Scene& scene, double depth, const Vec3d& normal) {
  ASSERT_EQ(scene.result().curves.size(), 1u);
  const IntersectionCurve& curve = scene.result().curves[0];
  EXPECT_NEAR(curve.depth, depth, 1e-12);
  EXPECT_NEAR(norm(curve.normal - normal), 0, 1e-12);
  EXPECT_TRUE(verify(scene).agrees());
}

/// A crate that is 1/16 in the floor, whose middle is below the crate.
const TriangleMesh crate = moved(make_box({2, 2, 2}, 1), {0.25, 0.9375, 0.125});
const TriangleMesh ground = moved(make_box({10, 2, 10}, 1), {0, -1, 0});

TEST(Orientation, OfSolidsThatAreInsideOut) {
  for (const bool crate_is : {false, true}) {
    for (const bool ground_is : {false, true}) {
      Scene scene(penetration);
      scene.add(crate_is ? inside_out(crate) : crate, {.solid = true});
      scene.add(ground_is ? inside_out(ground) : ground, {.solid = true});
      scene.detect();
      expect_depth(scene, 0.0625, {0, 1, 0});
    }
  }
}

/// The names of features and the contacts are those of the user's triangles.
TEST(Orientation, LeavesContactsAlone) {
  Scene scene(penetration), plain({.contacts = ContactKinds::intersection});
  for (Scene* const added : {&scene, &plain}) {
    added->add(inside_out(crate), {.solid = added == &scene});
    added->add(ground, {.solid = added == &scene});
    added->detect();
  }
  ASSERT_EQ(scene.result().contacts.size(), plain.result().contacts.size());
  for (std::size_t i = 0; i < plain.result().contacts.size(); ++i) {
    const Contact &found = scene.result().contacts[i], &expected = plain.result().contacts[i];
    EXPECT_EQ(found.normal, expected.normal);
    for (std::size_t k = 0; k < expected.point_count; ++k)
      EXPECT_EQ(scene.result().points_of(found)[k], plain.result().points_of(expected)[k]);
  }
}

TEST(Orientation, OfMirroredObjects) {
  constexpr std::array<double, 9> mirror{-1, 0, 0, 0, 1, 0, 0, 0, 1},
      point_mirror{-2, 0, 0, 0, -0.5, 0, 0, 0, -1};
  for (const bool is_solid : {false, true}) {
    for (const bool is_inside_out : {false, is_solid}) {
      Scene scene(penetration);
      const ObjectId a = scene.add(is_inside_out ? inside_out(crate) : crate, {.solid = is_solid});
      scene.add(ground, {.solid = is_solid});
      scene.set_transform(a, {.rotation = mirror});
      scene.detect();
      expect_depth(scene, 0.0625, {0, 1, 0});
      scene.set_transform(a, {.rotation = point_mirror, .translation = {0, 0.90625, 0}});
      scene.detect();
      // The crate is from 0.03125 below the ground up.
      expect_depth(scene, 0.0625, {0, 1, 0});
      scene.set_transform(a, {});
      scene.detect();
      expect_depth(scene, 0.0625, {0, 1, 0});
    }
  }
}

TEST(Orientation, FollowsThePositions) {
  Scene scene(penetration);
  const ObjectId a = scene.add(crate, {.solid = true});
  scene.add(ground, {.solid = true});
  std::vector<Vec3d> mirrored = crate.positions;
  for (Vec3d& p : mirrored) p.x = -p.x;
  scene.set_positions(a, mirrored);
  scene.detect();
  expect_depth(scene, 0.0625, {0, 1, 0});
  std::vector<std::uint32_t> all;
  for (std::uint32_t v = 0; v < crate.positions.size(); ++v) all.push_back(v);
  scene.set_vertices(a, all, crate.positions);
  scene.detect();
  expect_depth(scene, 0.0625, {0, 1, 0});
  // Flat, and then back.
  std::vector<Vec3d> flat = crate.positions;
  for (Vec3d& p : flat) p.x = 0;
  scene.set_positions(a, flat);
  scene.detect();
  EXPECT_TRUE(verify(scene).agrees());
  scene.set_positions(a, mirrored);
  scene.detect();
  expect_depth(scene, 0.0625, {0, 1, 0});
}

TEST(Orientation, OfClosedParts) {
  const TriangleMesh away = moved(crate, {20, 0, 0});
  for (const bool first : {false, true}) {
    for (const bool second : {false, true}) {
      Scene scene(penetration);
      scene.add(both(first ? inside_out(crate) : crate, second ? inside_out(away) : away), {.solid = true});
      scene.add(ground, {.solid = true});
      scene.detect();
      expect_depth(scene, 0.0625, {0, 1, 0});
    }
  }
}

/// A room is a box with a hole. A crate in it is in its floor, whichever way the triangles of both turn.
TEST(Orientation, OfHoles) {
  const TriangleMesh outside = moved(make_box({12, 12, 12}, 1), {0, 5, 0}),
                     hole = moved(make_box({10, 10, 10}, 1), {0, 5, 0});
  for (const bool outside_is : {false, true}) {
    for (const bool hole_is : {false, true}) {
      Scene scene(penetration);
      scene.add(crate, {.solid = true});
      scene.add(both(outside_is ? inside_out(outside) : outside, hole_is ? inside_out(hole) : hole),
                {.solid = true});
      scene.detect();
      expect_depth(scene, 0.0625, {0, 1, 0});
    }
  }
}

/// Two boxes that cross each other, also with the lower one's box in that of the other: none is a hole.
TEST(Orientation, OfPartsThatCross) {
  const TriangleMesh ball = moved(scaled(make_icosphere(4), 3), {0, 2.9375, 0});
  const TriangleMesh small = moved(make_box({1.5, 1.5, 1.5}, 1), {1.4, 2.9375, 1.4});
  for (const bool is_inside_out : {false, true}) {
    Scene scene(penetration);
    scene.add(both(is_inside_out ? inside_out(small) : small, ball), {.solid = true});
    scene.add(moved(make_box({1, 1, 1}, 1), {2.64, 2.9375, 2.64}), {.solid = true});
    scene.detect();
    ASSERT_EQ(scene.result().curves.size(), 1u);
    EXPECT_LT(scene.result().curves[0].normal.x, 0);
    EXPECT_GT(scene.result().curves[0].depth, 0);
  }
}

/// Volumes that doubles cannot tell from 0.
TEST(Orientation, IsExact) {
  for (const double height : {0x1p-300, 0x1p-1074, 0x1p-60}) {
    const TriangleMesh sliver{.name = {},
                              .positions = {{-3, 0, -3}, {3, 0, -3}, {0, 0, 4}, {0, height, 0}},
                              .triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
    std::array<Vec3d, 2> areas;
    for (const bool is_inside_out : {false, true}) {
      Scene scene(penetration);
      scene.add(is_inside_out ? inside_out(sliver) : sliver, {.solid = true});
      scene.add(make_box({1, 2, 1}, 1), {.solid = true});
      const auto curves = scene.detect().curves;
      ASSERT_FALSE(curves.empty());
      areas[is_inside_out ? 1 : 0] = curves[0].normal;
    }
    EXPECT_EQ(areas[0], areas[1]);
  }
}

TEST(Orientation, RefusesSingularMatricesOfSolids) {
  Scene scene(penetration);
  const ObjectId a = scene.add(crate, {.name = "crate", .solid = true}), b = scene.add(crate);
  const RigidTransform flat{.rotation = {1, 2, 3, 2, 4, 6, 0, 0, 1}};
  EXPECT_NO_THROW(scene.set_transform(b, flat));
  try {
    scene.set_transform(a, flat);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("crate"), std::string::npos);
  }
  EXPECT_EQ(scene.position(a, 0), crate.positions[0]);
}

}  // namespace supple::orientation_test
