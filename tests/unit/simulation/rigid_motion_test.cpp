#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "geometry/vector.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/verify.hpp"

namespace supple::rigid_motion_test {

using Points = std::vector<Vec3d>;

Points copied(std::span<const Vec3d> points) {
  return {points.begin(), points.end()};
}

TriangleMesh ball(double radius, Vec3d at) {
  TriangleMesh mesh = make_icosphere(3);
  for (Vec3d& p : mesh.positions) p = radius * p + at;
  return mesh;
}

double largest_distance(std::span<const Vec3d> a, std::span<const Vec3d> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
  return largest;
}

/// The simulation and its scene must have the same bits.
void expect_scene_agrees(const Simulation& simulation, ObjectId id) {
  const std::span<const Vec3d> positions = simulation.positions(id);
  for (std::uint32_t v = 0; v < positions.size(); ++v)
    ASSERT_EQ(simulation.scene().position(id, v), positions[v]) << v;
}

constexpr Border room{{{-1, -1, -1}, {1, 1, 1}}};

/// Balls in a room; every second one spins.
std::vector<ObjectId> fill(Simulation& simulation, bool with_spin = true) {
  std::vector<ObjectId> ids;
  for (int i = 0; i < 8; ++i) {
    const Vec3d at{i % 2 - 0.5, i / 2 % 2 - 0.5, i / 4 - 0.5};
    RigidMotion motion{.random_speed = 0.7};
    if (with_spin && i % 2 == 0) motion.random_spin = 200;
    ids.push_back(simulation.add(ball(0.2, at), {}, motion));
  }
  return ids;
}

TEST(RigidMotion, TranslatesWithoutReadingTheVertices) {
  Simulation simulation({.border = room, .seed = 3});
  const std::vector<ObjectId> ids = fill(simulation, false);
  simulation.detect();
  std::size_t contacts = 0;
  for (int step = 0; step < 200; ++step) {
    const DetectResult& result = simulation.step();
    EXPECT_EQ(result.stats.objects_refitted, 0u);
    EXPECT_EQ(result.stats.triangles_refitted, 0u);
    contacts += result.contacts.size();
    if (step % 10 == 0) {
      EXPECT_TRUE(verify(simulation.scene()).agrees());
    }
  }
  EXPECT_GT(contacts, 100u);
  for (const ObjectId id : ids) expect_scene_agrees(simulation, id);
}

TEST(RigidMotion, MovesAtConstantVelocity) {
  Simulation simulation({.time_step = 0.25});
  const TriangleMesh mesh = ball(1, {});
  const ObjectId id = simulation.add(mesh, {}, RigidMotion{.velocity = {1, -2, 0.5}});
  for (int step = 1; step <= 16; ++step) {
    simulation.step();
    const Vec3d way = 0.25 * step * Vec3d{1, -2, 0.5};  // exact
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      ASSERT_EQ(simulation.positions(id)[v], mesh.positions[v] + way);
  }
  EXPECT_EQ(simulation.body(id), nullptr);
}

TEST(RigidMotion, TurnsAboutItsCentreWhileItMoves) {
  // A quarter turn about z per second: (x, y) becomes (-y, x).
  Simulation simulation({.time_step = 0.125});
  const Vec3d centre{5, 6, 7};
  TriangleMesh mesh = make_box({1, 2, 3});
  for (Vec3d& p : mesh.positions) p = p + centre;
  const ObjectId id = simulation.add(mesh, {}, RigidMotion{.velocity = {0, 0, 2}, .spin = {0, 0, 90}});
  for (int step = 1; step <= 32; ++step) {
    simulation.step();
    const double seconds = 0.125 * step, angle = std::acos(-1.0) / 2 * seconds;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3d arm = mesh.positions[v] - centre;
      const Vec3d expected{std::cos(angle) * arm.x - std::sin(angle) * arm.y,
                           std::sin(angle) * arm.x + std::cos(angle) * arm.y, arm.z + 2 * seconds};
      ASSERT_LT(norm(simulation.positions(id)[v] - centre - expected), 1e-13);
    }
    expect_scene_agrees(simulation, id);
  }
}

TEST(RigidMotion, SpinsAboutAnyAxisAndKeepsItsShape) {
  Simulation simulation({.seed = 5});
  const TriangleMesh mesh = ball(1, {3, 0, 0});
  const Vec3d spin{30, -50, 80};
  const ObjectId id = simulation.add(mesh, {}, RigidMotion{.spin = spin});
  const ObjectId at_random = simulation.add(mesh, {}, RigidMotion{.random_spin = 90});
  Points before = copied(simulation.positions(id));
  const double h = simulation.options().time_step, to_radians = std::acos(-1.0) / 180;
  for (int step = 0; step < 100; ++step) {
    simulation.step();
    const std::span<const Vec3d> now = simulation.positions(id);
    for (std::size_t v = 0; v < now.size(); ++v) {
      // The mean velocity of a step is ω × r up to terms of third order.
      const Vec3d middle = 0.5 * (now[v] + before[v]) - Vec3d{3, 0, 0};
      ASSERT_LT(norm((now[v] - before[v]) * (1 / h) - cross(to_radians * spin, middle)), 1e-3);
    }
    before = copied(now);
  }
  // A quarter turn moves vertices of the unit ball by up to √2.
  EXPECT_NEAR(largest_distance(simulation.positions(at_random), mesh.positions), std::sqrt(2), 0.05);
  const Vec3d side = simulation.positions(id)[7] - simulation.positions(id)[3];
  EXPECT_NEAR(norm(side), norm(mesh.positions[7] - mesh.positions[3]), 1e-12);
}

TEST(RigidMotion, IsReflectedAtTheBorder) {
  Simulation simulation({.border = room, .seed = 4});
  const std::vector<ObjectId> ids = fill(simulation);
  const double longest_step = 0.7 * simulation.options().time_step;
  int touched = 0;
  std::vector<Points> before;
  for (const ObjectId id : ids) before.push_back(copied(simulation.positions(id)));
  for (int step = 0; step < 2000; ++step) {
    simulation.step();
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::span<const Vec3d> now = simulation.positions(ids[i]);
      Vec3d middle, middle_before;
      for (std::size_t v = 0; v < now.size(); ++v) {
        middle += now[v] * (1.0 / static_cast<double>(now.size()));
        middle_before += before[i][v] * (1.0 / static_cast<double>(now.size()));
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_LE(std::fabs(now[v][axis]), 1 + 2 * longest_step);
          touched += std::fabs(now[v][axis]) > 1 ? 1 : 0;
        }
      }
      ASSERT_NEAR(norm(middle - middle_before), longest_step, 1e-12) << "the speed stays";
      before[i] = copied(now);
    }
  }
  EXPECT_GT(touched, 100);
}

TEST(RigidMotion, OfAnObjectLargerThanTheBorderStaysInPlace) {
  Simulation simulation({.border = room});
  const TriangleMesh mesh = ball(1.5, {});
  const ObjectId id = simulation.add(mesh, {}, RigidMotion{.velocity = {0.5, 0.25, 0}});
  for (int step = 0; step < 101; ++step) simulation.step();
  EXPECT_LT(largest_distance(simulation.positions(id), mesh.positions), 0.02);
}

TEST(RigidMotion, DependsOnTheSeedAlone) {
  const auto run = [](std::uint64_t seed, std::uint32_t threads) {
    Simulation simulation({.scene = {.threads = threads}, .border = room, .seed = seed});
    std::vector<Points> all;
    const auto ids = fill(simulation);
    for (int step = 0; step < 50; ++step) simulation.step();
    for (const ObjectId id : ids) all.push_back(copied(simulation.positions(id)));
    return all;
  };
  const auto one = run(1, 1);
  EXPECT_EQ(one, run(1, 3));
  EXPECT_NE(one, run(2, 1));
  Points relative;
  for (const Points& points : one) relative.push_back(points[0]);
  std::sort(relative.begin(), relative.end(), [](Vec3d a, Vec3d b) { return a.x < b.x; });
  EXPECT_EQ(std::adjacent_find(relative.begin(), relative.end()), relative.end());

  Simulation simulation;
  const TriangleMesh mesh = ball(1, {});
  const ObjectId first = simulation.add(mesh, {}, RigidMotion{.random_speed = 1, .seed = 9});
  const ObjectId second = simulation.add(mesh, {}, RigidMotion{.random_speed = 1, .seed = 9});
  simulation.step();
  EXPECT_EQ(copied(simulation.positions(first)), copied(simulation.positions(second)));
}

TEST(RigidMotion, HasTheSamePositionsWithContinuousContacts) {
  const auto run = [](ContactKinds contacts) {
    Simulation simulation({.scene = {.contacts = contacts}, .border = room, .seed = 6});
    const auto ids = fill(simulation);
    std::size_t found = 0;
    std::vector<Points> all;
    simulation.detect();
    for (int step = 0; step < 100; ++step) {
      const DetectResult& result = simulation.step();
      found += result.contacts.size() + result.continuous_contacts.size();
      if (step % 25 == 0) {
        EXPECT_TRUE(verify(simulation.scene()).agrees());
        simulation.detect();  // places the objects at rest; the next step starts there
      }
    }
    EXPECT_GT(found, 0u);
    for (const ObjectId id : ids) {
      expect_scene_agrees(simulation, id);
      all.push_back(copied(simulation.positions(id)));
    }
    return all;
  };
  EXPECT_EQ(run(ContactKinds::intersection), run(ContactKinds::continuous));
}

TEST(RigidMotion, TellsWhenTwoObjectsMeet) {
  Simulation simulation({.scene = {.contacts = ContactKinds::continuous}, .time_step = 1});
  TriangleMesh left = make_box({1, 1, 1}), right = make_box({0.5, 0.5, 0.5});
  for (Vec3d& p : right.positions) p = p + Vec3d{2, 0, 0};
  simulation.add(left, {}, RigidMotion{.velocity = {1, 0, 0}});
  simulation.add(right, {}, RigidMotion{.velocity = {-1, 0, 0}});
  // The sides are 1.25 apart and approach by 2.
  const DetectResult& result = simulation.step();
  ASSERT_FALSE(result.continuous_contacts.empty());
  double first = 1;
  for (const ContinuousContact& contact : result.continuous_contacts) first = std::min(first, contact.toi);
  EXPECT_LE(first, 0.625);
  EXPECT_GT(first, 0.625 - 1e-9);
}

TEST(RigidMotion, GoesOnFromPositionsThatTheUserSets) {
  Simulation simulation({.time_step = 0.5});
  const TriangleMesh mesh = make_box({1, 2, 3});
  const ObjectId id = simulation.add(mesh, {}, RigidMotion{.velocity = {1, 0, 0}, .spin = {0, 0, 180}});
  simulation.step();
  simulation.set_positions(id, mesh.positions);
  EXPECT_EQ(copied(simulation.positions(id)), mesh.positions);
  simulation.step();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3d p = mesh.positions[v];
    EXPECT_LT(norm(simulation.positions(id)[v] - Vec3d{0.5 - p.y, p.x, p.z}), 1e-15) << "a quarter turn";
  }
  expect_scene_agrees(simulation, id);
}

TEST(RigidMotion, IgnoresVerticesThatAreNotFinite) {
  Simulation simulation({.border = room});
  TriangleMesh mesh = ball(0.5, {});
  mesh.positions[0] = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  const ObjectId id = simulation.add(mesh, {}, RigidMotion{.velocity = {2, 0, 0}, .spin = {0, 20, 0}});
  for (int step = 0; step < 500; ++step) simulation.step();
  for (std::size_t v = 1; v < mesh.positions.size(); ++v)
    ASSERT_LT(std::fabs(simulation.positions(id)[v].x), 1.05);
}

TEST(RigidMotion, StopsWithTheBodyThatFails) {
  MassSpringMotion exploding;
  exploding.springs.stiffness = 1e12;
  exploding.springs.damping = 0;
  exploding.random_force = 1;
  exploding.deform_seconds = 1e9;
  Simulation simulation;
  const ObjectId rigid = simulation.add(ball(1, {}), {}, RigidMotion{.velocity = {1, 0, 0}});
  simulation.add(ball(1, {0, 5, 0}), {}, exploding);
  Points before;
  std::optional<MotionError> error;
  while (!error && simulation.step_count() < 1000) {
    before = copied(simulation.positions(rigid));
    error = simulation.try_step();
  }
  ASSERT_TRUE(error);
  EXPECT_EQ(copied(simulation.positions(rigid)), before);
}

TEST(RigidMotion, PushesBodiesAside) {
  SimulationOptions options;
  options.response = ContactResponse{.thickness = 0.02};
  Simulation simulation(options);
  MassSpringMotion soft;
  soft.springs.bending_stiffness = 50;
  const ObjectId body = simulation.add(ball(0.5, {}), {}, soft);
  simulation.add(ball(0.5, {-1.2, 0, 0}), {}, RigidMotion{.velocity = {0.5, 0, 0}});
  for (int step = 0; step < 150; ++step) simulation.step();
  EXPECT_GT(simulation.body(body)->center_of_mass().x, 0.1);
}

TEST(RigidMotion, RefusesOptionsOutOfTheirRange) {
  const auto message = [](const RigidMotion& motion, const ObjectOptions& object = {}) -> std::string {
    Simulation simulation;
    try {
      simulation.add(make_box({1, 1, 1}), object, motion);
    } catch (const Error& error) {
      EXPECT_TRUE(simulation.scene().objects().empty());
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({.random_speed = -1}).find("random_speed is -1"), std::string::npos);
  EXPECT_NE(message({.random_spin = -1}).find("random_spin is -1"), std::string::npos);
  EXPECT_NE(message({.spin = {0, NAN, 0}}).find("spin is (0, nan, 0)"), std::string::npos);
  EXPECT_NE(message({}, {.is_static = true}).find("is static and has a motion"), std::string::npos);
  EXPECT_EQ(message({}), "");
}

}  // namespace supple::rigid_motion_test
