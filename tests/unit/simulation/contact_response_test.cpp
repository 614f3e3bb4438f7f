#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/vector.hpp"
#include "supple/models.hpp"
#include "supple/simulation.hpp"

namespace supple::contact_response_test {

TriangleMesh placed(TriangleMesh mesh, double size, Vec3d at) {
  for (Vec3d& p : mesh.positions) p = size * p + at;
  return mesh;
}

SimulationOptions responding(double time_step) {
  SimulationOptions options;
  options.time_step = time_step;
  options.scene.threads = 1;
  options.response = ContactResponse{.thickness = 0.01};
  return options;
}

MassSpringMotion stiff() {
  MassSpringMotion motion;
  motion.springs.vertex_mass = 1e-2;
  motion.springs.stiffness = 200;
  motion.springs.bending_stiffness = 100;
  motion.springs.damping = 0.02;
  return motion;
}

struct Momentum {
  Vec3d linear, angular;
};

Momentum momentum_of(const Simulation& simulation) {
  Momentum sum;
  for (const ObjectId id : simulation.scene().objects()) {
    if (const MassSpringBody* const body = simulation.body(id)) {
      sum.linear = sum.linear + body->momentum();
      sum.angular = sum.angular + body->angular_momentum();
    }
  }
  return sum;
}

TEST(ContactResponse, IsOffByDefault) {
  SimulationOptions options = responding(0.002);
  options.response.reset();
  Simulation simulation(options);
  MassSpringMotion motion = stiff();
  motion.velocity = {2, 0, 0};
  const ObjectId id = simulation.add(placed(make_icosphere(2), 0.2, {-0.5, 0, 0}), {}, motion);
  simulation.add(placed(make_icosphere(2), 0.2, {0, 0, 0}));
  for (int step = 0; step < 100; ++step) simulation.step();
  EXPECT_LT(norm(simulation.body(id)->mean_velocity() - Vec3d{2, 0, 0}), 1e-12);
  EXPECT_GT(simulation.detect().contacts.size(), 0u);
}

TEST(ContactResponse, BallsBounceAndKeepTheirMomentum) {
  for (const double friction : {0.0, 0.4}) {
    SimulationOptions options = responding(0.002);
    options.response->friction = friction;
    Simulation simulation(options);
    MassSpringMotion motion = stiff();
    motion.velocity = {1, 0, 0};
    const ObjectId left = simulation.add(placed(make_icosphere(3), 0.25, {-0.4, 0, 0}), {}, motion);
    motion.velocity = {-0.5, 0, 0};
    motion.springs.vertex_mass *= 2;
    const ObjectId right = simulation.add(placed(make_icosphere(3), 0.25, {0.4, 0.1, 0}), {}, motion);
    const Momentum before = momentum_of(simulation);
    const double energy_before =
        simulation.body(left)->energy().total() + simulation.body(right)->energy().total();
    std::size_t intersections = 0;
    for (int step = 0; step < 400; ++step) {
      intersections += simulation.step().contacts.size();
      ASSERT_LT(norm(momentum_of(simulation).linear - before.linear), 1e-13);
    }
    EXPECT_EQ(intersections, 0u);
    const double left_speed = simulation.body(left)->mean_velocity().x;
    const double right_speed = simulation.body(right)->mean_velocity().x;
    EXPECT_LT(left_speed, right_speed - 0.1);
    EXPECT_LT(simulation.body(left)->energy().total() + simulation.body(right)->energy().total(),
              energy_before);
  }
}

TEST(ContactResponse, ClothLiesOnABall) {
  SimulationOptions options = responding(0.004);
  options.response->friction = 0.3;
  Simulation simulation(options);
  simulation.add(placed(make_icosphere(4), 0.3, {}), {.is_static = true});
  MassSpringMotion motion;
  motion.springs.vertex_mass = 8e-3;
  motion.springs.stiffness = 40;
  motion.springs.damping = 0.02;
  motion.springs.air_friction = 4e-3;
  motion.springs.gravity = {0, -9.81, 0};
  const ObjectId cloth =
      simulation.add(placed(make_cloth(10, 10), 1, {0, 0.35, 0}), {.self_collision = true}, motion);
  std::size_t intersections = 0;
  for (int step = 0; step < 250; ++step) intersections += simulation.step().contacts.size();
  EXPECT_EQ(intersections, 0u);
  double highest = -1, lowest = 1;
  for (const Vec3d& p : simulation.positions(cloth)) {
    EXPECT_GT(norm(p), 0.28);
    highest = std::max(highest, p.y);
    lowest = std::min(lowest, p.y);
  }
  EXPECT_NEAR(highest, 0.31, 0.02);
  EXPECT_LT(lowest, 0);
}

TEST(ContactResponse, RestitutionReturnsSpeedAndFrictionTakesIt) {
  // A single triangle without springs that falls flat onto a plate.
  const auto velocity_after = [](double restitution, double friction) {
    SimulationOptions options = responding(0.01);
    options.response->restitution = restitution;
    options.response->friction = friction;
    Simulation simulation(options);
    simulation.add(make_cloth(1, 1, 10, 10), {.is_static = true});
    TriangleMesh triangle;
    triangle.positions = {{-0.1, 0.03, -0.1}, {0, 0.03, 0.1}, {0.1, 0.03, -0.1}};
    triangle.triangles = {{0, 1, 2}};
    MassSpringMotion motion;
    motion.springs.stiffness = motion.springs.damping = 0;
    motion.velocity = {1, -4, 0};
    const ObjectId id = simulation.add(triangle, {}, motion);
    simulation.step();
    return simulation.body(id)->mean_velocity();
  };
  EXPECT_LT(norm(velocity_after(0, 0) - Vec3d{1, 0, 0}), 1e-9);
  EXPECT_LT(norm(velocity_after(1, 0) - Vec3d{1, 4, 0}), 1e-9);
  EXPECT_LT(norm(velocity_after(0.5, 0) - Vec3d{1, 2, 0}), 1e-9);
  EXPECT_LT(norm(velocity_after(0, 0.125) - Vec3d{0.5, 0, 0}), 1e-9);
  EXPECT_LT(norm(velocity_after(0, 1) - Vec3d{0, 0, 0}), 1e-9);
}

TEST(ContactResponse, PushesApartWhatIsTooNear) {
  SimulationOptions options = responding(0.01);
  Simulation simulation(options);
  simulation.add(make_cloth(1, 1, 10, 10), {.is_static = true});
  TriangleMesh triangle;
  triangle.positions = {{-0.1, 0.002, -0.1}, {0, 0.002, 0.1}, {0.1, 0.002, -0.1}};
  triangle.triangles = {{0, 1, 2}};
  MassSpringMotion motion;
  motion.springs.stiffness = motion.springs.damping = 0;
  motion.springs.gravity = {0, -9.81, 0};
  const ObjectId id = simulation.add(triangle, {}, motion);
  double before = 0.002;
  for (int step = 0; step < 80; ++step) {
    simulation.step();
    const double height = simulation.positions(id)[0].y;
    EXPECT_GT(height, before - 1e-6);
    EXPECT_LT(height, before + 0.001);
    before = height;
  }
  EXPECT_GT(before, 0.009);
  EXPECT_LT(before, 0.0101);
}

TEST(ContactResponse, FixedAndFunctionDrivenVerticesAreNotMoved) {
  SimulationOptions options = responding(0.005);
  Simulation simulation(options);
  MassSpringMotion motion = stiff();
  motion.springs.fixed_vertices = {0, 4, 20, 24};
  const TriangleMesh cloth = make_cloth(4, 4);
  const ObjectId held = simulation.add(cloth, {}, motion);
  const TriangleMesh ball = placed(make_icosphere(3), 0.2, {0, 0.3, 0});
  const ObjectId pusher = simulation.add(ball, {}, [&](double seconds, std::span<Vec3d> positions) {
    for (std::size_t i = 0; i < positions.size(); ++i)
      positions[i] = ball.positions[i] - Vec3d{0, 0.5 * seconds, 0};
  });
  for (int step = 0; step < 60; ++step) simulation.step();
  for (const std::uint32_t v : motion.springs.fixed_vertices)
    EXPECT_EQ(simulation.positions(held)[v], cloth.positions[v]);
  EXPECT_EQ(simulation.positions(pusher)[0], (ball.positions[0] - Vec3d{0, 0.5 * simulation.time(), 0}));
  EXPECT_LT(simulation.positions(held)[12].y, -0.03);
  EXPECT_EQ(simulation.detect().contacts.size(), 0u);
}

double energy_of(const Simulation& simulation) {
  double sum = 0;
  for (const ObjectId id : simulation.scene().objects()) {
    if (const MassSpringBody* const body = simulation.body(id)) sum += body->energy().total();
  }
  return sum;
}

/// With steps of 10 ms, ten times too long for the springs, only substeps keep the motion stable.
TEST(ContactResponse, FeedsNoEnergyToSpringsAtLongSteps) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::symplectic_euler}) {
    SimulationOptions options = responding(0.01);
    options.response->thickness = 0.02;
    options.response->friction = 0.3;
    Simulation simulation(options);
    simulation.add(placed(make_icosphere(6), 0.5, {}), {.is_static = true});
    MassSpringMotion motion;
    motion.springs.integrator = integrator;
    motion.springs.substeps = 8;
    motion.springs.vertex_mass = 1e-3;
    motion.springs.stiffness = 40;
    motion.springs.bending_stiffness = 1;
    motion.springs.damping = 0.005;
    motion.springs.gravity = {0, -9.81, 0};
    simulation.add(placed(make_cloth(14, 14), 1.6, {0.05, 0.6, 0.03}), {.self_collision = true}, motion);
    const double at_first = energy_of(simulation);
    double lowest = at_first;
    std::size_t contacts = 0;
    for (int step = 0; step < 200; ++step) {
      contacts += simulation.step().contacts.size();
      const double energy = energy_of(simulation);
      // The response may raise the energy slightly when it separates vertices against gravity and springs.
      ASSERT_LT(energy, lowest + 0.03 * at_first) << "step " << step;
      lowest = std::min(lowest, energy);
    }
    EXPECT_EQ(contacts, 0u);
    EXPECT_LT(lowest, 0.4 * at_first);
  }
}

TEST(ContactResponse, FeedsNoEnergyToBallsThatMeetAtLongSteps) {
  Simulation simulation(responding(0.01));
  for (int i = 0; i < 4; ++i) {
    MassSpringMotion motion;
    motion.springs.substeps = 16;
    motion.springs.vertex_mass = 1e-2;
    motion.springs.stiffness = 600;
    motion.springs.bending_stiffness = 300;
    motion.springs.damping = 0;
    motion.springs.volume_stiffness = 2000;
    motion.velocity = {i % 2 == 0 ? 2.0 : -2.0, i < 2 ? 1.0 : -1.0, 0};
    simulation.add(placed(make_icosphere(3), 0.25, {i % 2 == 0 ? -0.5 : 0.5, i < 2 ? -0.5 : 0.5, 0.05 * i}),
                   {}, motion);
  }
  simulation.step();
  const Momentum before = momentum_of(simulation);
  const double energy_before = energy_of(simulation);
  for (int step = 0; step < 200; ++step) {
    simulation.step();
    ASSERT_LT(energy_of(simulation), 1.02 * energy_before) << "step " << step;
    ASSERT_LT(norm(momentum_of(simulation).linear - before.linear), 1e-12);
  }
  EXPECT_LT(energy_of(simulation), 0.8 * energy_before);
}

TEST(ContactResponse, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto run = [](std::uint32_t threads) {
    SimulationOptions options = responding(0.004);
    options.scene.threads = threads;
    Simulation simulation(options);
    for (int i = 0; i < 3; ++i) {
      MassSpringMotion motion = stiff();
      motion.velocity = {i == 0 ? 1.5 : -1.0, 0, 0};
      simulation.add(placed(make_icosphere(3), 0.2, {0.5 * i, 0.05 * i, 0}), {}, motion);
    }
    for (int step = 0; step < 100; ++step) simulation.step();
    std::vector<Vec3d> all;
    for (const ObjectId id : simulation.scene().objects()) {
      const auto positions = simulation.positions(id);
      all.insert(all.end(), positions.begin(), positions.end());
    }
    return all;
  };
  const std::vector<Vec3d> one = run(1);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(3), one);
}

/// The response takes the proximity of the scene when the scene finds it, and otherwise finds the same.
TEST(ContactResponse, DoesNotDependOnTheContactsOfTheScene) {
  const auto run = [](ContactKinds contacts, ProximityListing listing, bool detects_between) {
    SimulationOptions options = responding(0.004);
    options.scene.contacts = contacts;
    options.scene.proximity_listing = listing;
    Simulation simulation(options);
    simulation.add(placed(make_icosphere(3), 0.2, {}), {.is_static = true, .margin = 0.01});
    MassSpringMotion motion = stiff();
    motion.velocity = {1.5, 0, 0};
    const ObjectId id = simulation.add(placed(make_icosphere(3), 0.2, {-0.5, 0.05, 0}), {}, motion);
    for (int step = 0; step < 100; ++step) {
      simulation.step();
      if (detects_between) simulation.detect();
    }
    const auto positions = simulation.positions(id);
    return std::vector<Vec3d>(positions.begin(), positions.end());
  };
  constexpr ContactKinds both = ContactKinds::intersection | ContactKinds::proximity;
  const std::vector<Vec3d> expected = run(both, ProximityListing::features, false);
  EXPECT_LT(expected.front().x, -0.4);
  EXPECT_EQ(run(ContactKinds::none, ProximityListing::features, false), expected);
  EXPECT_EQ(run(ContactKinds::continuous, ProximityListing::features, false), expected);
  EXPECT_EQ(run(both, ProximityListing::elements, false), expected);
  EXPECT_EQ(run(both, ProximityListing::features, true), expected);
}

TEST(ContactResponse, RaisesMarginsToThreeQuartersOfTheThickness) {
  SimulationOptions options = responding(0.01);
  options.scene.contacts = ContactKinds::proximity;
  Simulation simulation(options);
  simulation.add(make_cloth(1, 1), {});
  simulation.add(placed(make_cloth(1, 1), 1, {0, 0.014, 0}), {});
  EXPECT_EQ(simulation.detect().proximity_groups.size(), 1u);
}

TEST(ContactResponse, SurvivesRemovalAndTeleports) {
  Simulation simulation(responding(0.004));
  const ObjectId still = simulation.add(placed(make_icosphere(2), 0.2, {}));
  MassSpringMotion motion = stiff();
  motion.velocity = {1, 0, 0};
  const ObjectId first = simulation.add(placed(make_icosphere(2), 0.2, {-0.6, 0, 0}), {}, motion);
  for (int step = 0; step < 20; ++step) simulation.step();
  simulation.remove(first);
  const ObjectId second = simulation.add(placed(make_icosphere(2), 0.2, {-0.6, 0, 0}), {}, motion);
  EXPECT_EQ(second.index, first.index);
  simulation.set_positions(still, placed(make_icosphere(2), 0.2, {0, 5, 0}).positions);
  for (int step = 0; step < 300; ++step) simulation.step();
  EXPECT_LT(norm(simulation.body(second)->mean_velocity() - Vec3d{1, 0, 0}), 1e-12);
}

}  // namespace supple::contact_response_test
