#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/response.hpp"

namespace supple::respond_test {

constexpr double dt = 0.01;
constexpr ContactResponse thick{.thickness = 0.01};

struct Body {
  Body(Scene& scene, const TriangleMesh& mesh, Vec3d at, Vec3d velocity, double mass,
       const ObjectOptions& options = {.margin = least_margin(thick)})
      : positions(mesh.positions),
        velocities(mesh.positions.size(), velocity),
        masses(positions.size(), mass) {
    for (Vec3d& p : positions) p += at;
    id = scene.add({positions}, {mesh.triangles}, options);
  }
  ResponseBody body() { return {id, velocities, masses}; }
  Vec3d momentum() const {
    Vec3d sum;
    for (std::size_t v = 0; v < velocities.size(); ++v) sum += masses[v] * velocities[v];
    return sum;
  }
  void advance(Scene& scene, double seconds) {
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += seconds * velocities[v];
    scene.set_positions(id, positions);
  }

  ObjectId id;
  std::vector<Vec3d> positions, velocities;
  std::vector<double> masses;
};

TriangleMesh small_triangle() {
  TriangleMesh mesh;
  mesh.positions = {{-0.1, 0, -0.1}, {0, 0, 0.1}, {0.1, 0, -0.1}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

/// The velocities of a triangle above a plate at rest, after the response.
std::vector<Vec3d> above_a_plate(double height, Vec3d velocity, const ContactResponse& options) {
  Scene scene;
  scene.add(make_cloth(1, 1, 10, 10), {.is_static = true, .margin = least_margin(options)});
  Body triangle(scene, small_triangle(), {3, height, 0}, velocity, 2);
  EXPECT_EQ(respond(scene, triangle.id, triangle.velocities, triangle.masses, dt, options), 1);
  return triangle.velocities;
}

void expect_all_near(const std::vector<Vec3d>& velocities, Vec3d expected) {
  for (const Vec3d& v : velocities) EXPECT_LT(norm(v - expected), 1e-9) << v.x << ' ' << v.y << ' ' << v.z;
}

TEST(Respond, LeavesVelocitiesAloneThatMeetNothing) {
  EXPECT_EQ(above_a_plate(0.5, {1, -4, 0}, thick), std::vector<Vec3d>(3, {1, -4, 0}));
  EXPECT_EQ(above_a_plate(0.012, {1, 4, 0}, thick), std::vector<Vec3d>(3, {1, 4, 0}));
}

TEST(Respond, LetsNearElementsApproachByHalfTheDistanceToTheThickness) {
  expect_all_near(above_a_plate(0.0125, {0, -1, 0}, thick), {0, -0.125, 0});
  expect_all_near(above_a_plate(0.0125, {0, -0.1, 0}, thick), {0, -0.1, 0});
}

TEST(Respond, PushesElementsApartThatAreTooNear) {
  // By a tenth of the missing 4 mm.
  expect_all_near(above_a_plate(0.006, {0, -1e-3, 0}, thick), {0, 0.04, 0});
}

TEST(Respond, StopsWhatWouldPassThrough) {
  expect_all_near(above_a_plate(0.05, {1, -400, 0}, thick), {1, 0, 0});
}

TEST(Respond, RestitutionReturnsSpeedAndFrictionTakesIt) {
  ContactResponse options = thick;
  options.restitution = 0.5;
  expect_all_near(above_a_plate(0.05, {1, -8, 0}, options), {1, 4, 0});
  expect_all_near(above_a_plate(0.0125, {1, -8, 0}, options), {1, 4, 0});
  // Arrived within the thickness in the last step.
  expect_all_near(above_a_plate(0.009, {1, -8, 0}, options), {1, 4, 0});
  // Rests, and is pushed apart by a tenth of 4 mm.
  expect_all_near(above_a_plate(0.006, {1, -0.1, 0}, options), {1, 0.04, 0});
  options = thick;
  options.friction = 0.125;
  expect_all_near(above_a_plate(0.03, {1, -4, 0}, options), {0.5, 0, 0});
  options.friction = 1;
  expect_all_near(above_a_plate(0.03, {1, -4, 0}, options), {0, 0, 0});
}

TEST(Respond, ConservesMomentumBetweenBodies) {
  Scene scene;
  Body left(scene, make_icosphere(3), {-1.2, 0, 0}, {30, 0, 0}, 1);
  Body right(scene, make_icosphere(3), {1.2, 0.1, 0}, {-30, 0, 0}, 3);
  const Vec3d before = left.momentum() + right.momentum();
  const double left_before = left.momentum().x;
  const std::vector<ResponseBody> bodies{left.body(), right.body()};
  respond(scene, bodies, dt, {.thickness = 0.01, .friction = 0.3});
  EXPECT_LT(left.momentum().x, left_before - 10);
  EXPECT_LT(norm(left.momentum() + right.momentum() - before), 1e-9);
}

TEST(Respond, VerticesOfInfiniteMassAndBodiesWithoutMassesKeepTheirVelocity) {
  Scene scene;
  Body plate(scene, make_cloth(1, 1, 10, 10), {}, {0, 5, 0}, 1);
  Body triangle(scene, small_triangle(), {0, 0.02, 0}, {}, 1);
  triangle.masses[1] = std::numeric_limits<double>::infinity();
  const std::vector<ResponseBody> bodies{{plate.id, plate.velocities}, triangle.body()};
  EXPECT_LT(respond(scene, bodies, dt, thick), 1);
  EXPECT_EQ(plate.velocities, std::vector<Vec3d>(plate.velocities.size(), {0, 5, 0}));
  EXPECT_EQ(triangle.velocities[1], Vec3d{});
  // The other two make up for it.
  EXPECT_GT(triangle.velocities[0].y, 5 - 1e-6);
  EXPECT_GT(triangle.velocities[2].y, 5 - 1e-6);
}

/// A user's cloth of masses and springs on a ball: it lies there and never intersects anything.
std::vector<Vec3d> drape(std::uint32_t threads) {
  SceneOptions options;
  options.threads = threads;
  Scene scene(options);
  TriangleMesh ball = make_icosphere(5);
  for (Vec3d& p : ball.positions) p = 0.3 * p;
  scene.add(ball, {.is_static = true, .margin = least_margin(thick)});
  const TriangleMesh mesh = make_cloth(12, 12);
  Body cloth(scene, mesh, {0.01, 0.35, 0.02}, {}, 0.005,
             {.self_collision = true, .margin = least_margin(thick)});
  struct Spring {
    std::uint32_t a, b;
    double length;
  };
  std::vector<Spring> springs;
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      springs.push_back({a, b, norm(mesh.positions[a] - mesh.positions[b])});
    }
  }
  constexpr double step = 0.004;
  for (int i = 0; i < 250; ++i) {
    std::vector<Vec3d> forces(cloth.positions.size(), {0, -9.81 * 0.005, 0});
    for (const Spring& s : springs) {
      const Vec3d d = cloth.positions[s.b] - cloth.positions[s.a];
      const Vec3d f = d * (10 * (norm(d) - s.length) / norm(d));
      forces[s.a] += f;
      forces[s.b] -= f;
    }
    for (std::size_t v = 0; v < forces.size(); ++v)
      cloth.velocities[v] = 0.995 * cloth.velocities[v] + step / 0.005 * forces[v];
    const double part =
        respond(scene, cloth.id, cloth.velocities, cloth.masses, step, {.thickness = 0.01, .friction = 0.3});
    cloth.advance(scene, part * step);
    EXPECT_EQ(scene.detect({.contacts = ContactKinds::intersection}).contacts.size(), 0u) << "step " << i;
  }
  return cloth.positions;
}

TEST(Respond, ClothOfTheUserLiesOnABall) {
  const std::vector<Vec3d> positions = drape(1);
  double highest = -1, lowest = 1, nearest = 1;
  for (const Vec3d& p : positions) {
    highest = std::max(highest, p.y);
    lowest = std::min(lowest, p.y);
    nearest = std::min(nearest, norm(p));
  }
  EXPECT_NEAR(highest, 0.31, 0.02);
  EXPECT_LT(lowest, 0);
  EXPECT_GT(nearest, 0.3);
}

TEST(Respond, GivesTheSameBitsForAnyNumberOfThreads) {
  EXPECT_EQ(drape(3), drape(1));
}

TEST(Respond, TheReturnedPartOfTheStepIsFree) {
  // Two plates crush a ball faster than four rounds of impulses can resolve.
  Scene scene;
  Body below(scene, make_cloth(2, 2, 10, 10), {0, -1.02, 0}, {0, 30, 0}, 1);
  Body above(scene, make_cloth(2, 2, 10, 10), {0, 1.02, 0}, {0, -30, 0}, 1);
  Body ball(scene, make_icosphere(4), {}, {}, 1);
  const std::vector<ResponseBody> bodies{
      {below.id, below.velocities}, {above.id, above.velocities}, ball.body()};
  const double part = respond(scene, bodies, 10 * dt, thick);
  EXPECT_LT(part, 1);
  EXPECT_GT(part, 0);
  EXPECT_EQ(part, scene.max_step().step);
  for (Body* const body : {&below, &above, &ball}) body->advance(scene, part * 10 * dt);
  EXPECT_EQ(scene.detect().contacts.size(), 0u);
}

TEST(Respond, RejectsUnusableInput) {
  Scene scene;
  Body triangle(scene, small_triangle(), {}, {}, 1);
  const auto message = [&](std::span<const ResponseBody> bodies, double seconds,
                           const ContactResponse& options) -> std::string {
    try {
      respond(scene, bodies, seconds, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::vector<ResponseBody> one{triangle.body()}, twice{triangle.body(), triangle.body()};
  const std::vector<ResponseBody> short_of_masses{
      {triangle.id, triangle.velocities, std::span(triangle.masses).first(2)}};
  EXPECT_EQ(message(one, dt, thick), "");
  EXPECT_NE(message(one, 0, thick).find("step is 0"), std::string::npos);
  EXPECT_NE(message(one, dt, {.thickness = 0}).find("thickness"), std::string::npos);
  EXPECT_NE(message(twice, dt, thick).find("twice"), std::string::npos);
  EXPECT_NE(message(short_of_masses, dt, thick).find("3 vertices and 2 masses"), std::string::npos);
  triangle.masses[2] = -1;
  EXPECT_NE(message(one, dt, thick).find("vertex 2"), std::string::npos);
}

}  // namespace supple::respond_test
