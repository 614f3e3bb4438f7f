#include "supple/simulation.hpp"
#include "geometry/vector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/trigonometry.hpp"
#include "supple/verify.hpp"
#include "support/scenes.hpp"

namespace supple::simulation_test {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using Points = std::vector<Vec3d>;

Points copied(std::span<const Vec3d> points) {
  return {points.begin(), points.end()};
}

TriangleMesh placed(TriangleMesh mesh, double size, Vec3d at, const std::string& name = "") {
  for (Vec3d& p : mesh.positions) p = size * p + at;
  if (!name.empty()) mesh.name = name;
  return mesh;
}

/// A body that can wave but keeps its shape. It is stable with steps of 0.01 s.
MassSpringMotion springy() {
  MassSpringMotion motion;
  motion.springs.vertex_mass = 0.1;
  motion.springs.stiffness = 50;
  motion.springs.damping = 0.1;
  return motion;
}

/// A body that soon becomes unstable.
MassSpringMotion exploding() {
  MassSpringMotion motion = springy();
  motion.springs.stiffness = 1e9;
  motion.springs.damping = 0;
  motion.random_force = 1;
  motion.deform_seconds = 1e9;
  return motion;
}

SimulationOptions in_a_room(double half, ContactKinds contacts = ContactKinds::intersection) {
  SimulationOptions options;
  options.scene.contacts = contacts;
  options.scene.threads = 1;
  options.border = Border{{{-half, -half, -half}, {half, half, half}}};
  options.seed = 11;
  return options;
}

/// Bodies on a grid that first deform and then fly.
Simulation room_of_bodies(const SimulationOptions& options, int side = 2) {
  Simulation simulation(options);
  const TriangleMesh ball = make_icosphere(2);
  for (int i = 0; i < side * side * side; ++i) {
    const Vec3d cell{i % side - 0.5 * (side - 1), i / side % side - 0.5 * (side - 1),
                     i / side / side - 0.5 * (side - 1)};
    MassSpringMotion motion = springy();
    motion.random_speed = 1;
    motion.random_force = 1;
    motion.deform_seconds = 0.2;
    simulation.add(placed(ball, 0.2, cell, "ball " + std::to_string(i)), {}, motion);
  }
  return simulation;
}

std::vector<ObjectId> objects_of(const Simulation& simulation) {
  return simulation.scene().objects();
}

/// All state in which two runs can differ.
struct State {
  std::vector<Points> positions, velocities;
  std::uint64_t steps = 0;
  bool operator==(const State&) const = default;
};

State state_of(const Simulation& simulation) {
  State state;
  for (const ObjectId id : objects_of(simulation)) {
    state.positions.push_back(copied(simulation.positions(id)));
    const MassSpringBody* const body = simulation.body(id);
    if (body != nullptr) state.velocities.push_back(copied(body->velocities()));
  }
  state.steps = simulation.step_count();
  return state;
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Simulation, OfNothingSteps) {
  Simulation simulation;
  EXPECT_EQ(simulation.step().object_pairs.size(), 0u);
  EXPECT_EQ(simulation.step_count(), 1u);
  EXPECT_EQ(simulation.time(), 0.01);
  EXPECT_GE(simulation.motion_seconds(), 0);
}

TEST(Simulation, RefusesOptionsOutOfTheirRange) {
  const auto message = [](auto change) {
    SimulationOptions options;
    change(options);
    return message_of([&] { Simulation{options}; });
  };
  EXPECT_EQ(message([](auto& o) { o.time_step = 0; }),
            "SimulationOptions::time_step is 0; it must be a finite number above 0");
  EXPECT_NE(message([](auto& o) { o.time_step = not_a_number; }).find("time_step is nan"), std::string::npos);
  EXPECT_EQ(
      message([](auto& o) {
        o.border = Border{{{-1, 2, -1}, {1, 1, 1}}};
      }),
      "SimulationOptions::border: along y it goes from 2.000000 to 1.000000; the first corner must be the "
      "lower one");
  EXPECT_NE(message([](auto& o) { o.border = Border{{{-1, -1, not_a_number}, {1, 1, 1}}}; }), "");
  EXPECT_NE(message([](auto& o) { o.response = ContactResponse{.thickness = 0}; }), "");
  EXPECT_NE(message([](auto& o) { o.response = ContactResponse{.restitution = 1.5}; }), "");
  EXPECT_NE(message([](auto& o) { o.response = ContactResponse{.friction = -1}; }), "");
  EXPECT_NE(message([](auto& o) { o.response = ContactResponse{.iterations = 0}; }), "");
  EXPECT_NE(message([](auto& o) { o.scene.threads = 5000; }), "");
  EXPECT_EQ(message([](auto&) {}), "");
}

TEST(Simulation, RefusesMotionsOutOfTheirRange) {
  Simulation simulation;
  const TriangleMesh ball = placed(make_icosphere(1), 1, {}, "ball");
  const auto message = [&](auto change) {
    MassSpringMotion motion;
    change(motion);
    return message_of([&] { simulation.add(ball, {}, motion); });
  };
  EXPECT_EQ(message([](auto& m) { m.velocity.y = not_a_number; }),
            "motion of ball: MassSpringMotion::velocity is (0, nan, 0); it must be three finite numbers");
  EXPECT_NE(message([](auto& m) { m.random_speed = -1; }), "");
  EXPECT_NE(message([](auto& m) { m.random_force = -1; }), "");
  EXPECT_NE(message([](auto& m) { m.deform_seconds = -1; }), "");
  EXPECT_NE(message([](auto& m) { m.springs.vertex_mass = 0; }), "");
  EXPECT_EQ(
      message([](auto& m) {
        m.handles = {{{0, 12}, {}, 1}};
      }),
      "MassSpringMotion::handles[0] of ball: vertex 12 is out of range; there are 12 vertices, numbered from "
      "0");
  EXPECT_NE(message([](auto& m) { m.handles = {{{0}, {}, 0}}; }), "");
  EXPECT_NE(message([](auto& m) {
              m.handles = {{{0}, {}, 1}, {{0}, {}, 1}};
            }).find("held twice"),
            std::string::npos);
  EXPECT_EQ(message_of([&] { simulation.add(ball, {.is_static = true}, springy()); }),
            "ball is static and has a motion; leave one of them out");
  EXPECT_EQ(message_of([&] { simulation.add(ball, {}, MotionFunction()); }),
            "add: the motion of ball is an empty function");
  EXPECT_TRUE(objects_of(simulation).empty());
  simulation.step();
}

TEST(Simulation, RefusesObjectsThatAreNotThere) {
  Simulation simulation;
  const ObjectId gone = simulation.add(make_icosphere(1));
  simulation.remove(gone);
  EXPECT_THROW(simulation.positions(gone), Error);
  EXPECT_THROW(simulation.body(gone), Error);
  EXPECT_THROW(simulation.remove(gone), Error);
  EXPECT_THROW(simulation.set_positions(gone, {}), Error);
  EXPECT_THROW(simulation.positions({7, 0}), Error);
}

TEST(Simulation, FunctionsAreGivenTimeAndPositionsBefore) {
  SimulationOptions options;
  options.time_step = 0.25;
  Simulation simulation(options);
  std::vector<double> times;
  const ObjectId slide =
      simulation.add(make_icosphere(1), {}, [&](double seconds, std::span<Vec3d> positions) {
        times.push_back(seconds);
        for (Vec3d& p : positions) p.x += 1;
      });
  const Vec3d rest = make_icosphere(1).positions[3];
  simulation.step();
  simulation.step();
  EXPECT_EQ(times, (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(simulation.positions(slide)[3], (rest + Vec3d{2, 0, 0}));
  EXPECT_EQ(simulation.scene().position(slide, 3), (rest + Vec3d{2, 0, 0}));
  EXPECT_EQ(simulation.body(slide), nullptr);
  EXPECT_NE(message_of([&] { simulation.set_positions(slide, {}); }).find("moved by a function"),
            std::string::npos);
}

TEST(Simulation, AnExceptionOfTheUsersMotionChangesNothing) {
  Simulation simulation(in_a_room(2));
  simulation.add(placed(make_icosphere(2), 0.3, {1, 0, 0}), {}, springy());
  simulation.add(placed(make_icosphere(2), 0.3, {-1, 0, 0}), {},
                 [](double seconds, std::span<Vec3d> positions) { positions[0].x = seconds; });
  simulation.add(placed(make_icosphere(2), 0.3, {0, 1, 0}), {},
                 [](double seconds, std::span<Vec3d> positions) {
                   positions[0].x = seconds;
                   if (seconds > 0.035) throw std::domain_error("no further");
                 });
  for (int step = 0; step < 3; ++step) simulation.step();
  const State before = state_of(simulation);
  EXPECT_THROW(simulation.step(), std::domain_error);
  EXPECT_THROW(simulation.step(), std::domain_error);
  EXPECT_EQ(state_of(simulation), before);
}

TEST(Simulation, ABodyThatBlowsUpLeavesAllAsBefore) {
  for (const std::uint32_t threads : {1u, 3u}) {
    SimulationOptions options = in_a_room(2);
    options.scene.threads = threads;
    Simulation simulation = room_of_bodies(options);
    const ObjectId function =
        simulation.add(make_icosphere(1), {}, [](double seconds, std::span<Vec3d> positions) {
          for (Vec3d& p : positions) p.y += seconds;
        });
    // Plastic flow has additional state that affects later steps.
    MassSpringMotion plastic = springy();
    plastic.springs.yield_strain = 0.001;
    plastic.random_force = 2;
    plastic.deform_seconds = 1;
    simulation.add(placed(make_icosphere(2), 0.3, {0, 0, 0}), {}, plastic);
    for (int step = 0; step < 30; ++step) simulation.step();
    const ObjectId bad = simulation.add(placed(make_icosphere(1), 1, {}, "firework"), {}, exploding());
    State before = state_of(simulation);
    bool has_failed = false;
    for (int step = 0; step < 100 && !has_failed; ++step) {
      before = state_of(simulation);
      try {
        simulation.step();
      } catch (const MotionError& error) {
        has_failed = true;
        EXPECT_EQ(error.object, "firework");
        EXPECT_EQ(error.step, before.steps + 1);
        const std::string message = error.what();
        EXPECT_EQ(message.find("firework in step " + std::to_string(error.step) + ": "), 0u) << message;
      }
    }
    ASSERT_TRUE(has_failed);
    EXPECT_EQ(state_of(simulation), before);

    // `try_step` reports the same error without an exception.
    const auto error = simulation.try_step();
    ASSERT_TRUE(error);
    EXPECT_EQ(error->object, "firework");
    EXPECT_EQ(error->step, before.steps + 1);
    EXPECT_EQ(state_of(simulation), before);

    // After its removal, the simulation continues as if the body had never existed.
    simulation.remove(bad);
    Simulation undisturbed = room_of_bodies(options);
    undisturbed.add(make_icosphere(1), {}, [](double seconds, std::span<Vec3d> positions) {
      for (Vec3d& p : positions) p.y += seconds;
    });
    undisturbed.add(placed(make_icosphere(2), 0.3, {0, 0, 0}), {}, plastic);
    while (undisturbed.step_count() < before.steps) undisturbed.step();
    for (int step = 0; step < 10; ++step) {
      ASSERT_FALSE(simulation.try_step());
      undisturbed.step();
    }
    EXPECT_EQ(state_of(simulation), state_of(undisturbed));
    EXPECT_EQ(copied(simulation.positions(function)), copied(undisturbed.positions(function)));
  }
}

TEST(Simulation, DeformsInPlaceAndThenSendsOff) {
  SimulationOptions options;
  options.seed = 4;
  Simulation simulation(options);
  MassSpringMotion motion = springy();
  motion.random_force = 1;
  motion.deform_seconds = 0.3;
  motion.velocity = {1, 0, 0};
  motion.random_speed = 0.5;
  const TriangleMesh ball = make_icosphere(3);
  const ObjectId id = simulation.add(ball, {}, motion);
  const MassSpringBody& body = *simulation.body(id);
  const Vec3d centre = body.center_of_mass();
  double deformation = 0;
  for (int step = 0; step < 30; ++step) {
    EXPECT_LT(norm(body.mean_velocity()), 1e-12);
    simulation.step();
    for (std::size_t i = 0; i < ball.positions.size(); ++i)
      deformation = std::max(deformation, norm(simulation.positions(id)[i] - ball.positions[i]));
  }
  EXPECT_LT(norm(body.center_of_mass() - centre), 1e-12);
  EXPECT_GT(deformation, 0.05);
  EXPECT_LT(deformation, 1);

  const Vec3d sent = body.mean_velocity();
  EXPECT_NEAR(norm(sent - Vec3d{1, 0, 0}), 0.5, 1e-12);
  for (int step = 0; step < 20; ++step) simulation.step();
  EXPECT_LT(norm(body.mean_velocity() - sent), 1e-12);
  EXPECT_LT(norm(body.center_of_mass() - centre - sent * 0.2), 1e-12);
}

TEST(Simulation, SeedsRepeatAndObjectsDiffer) {
  const auto velocities = [](std::uint64_t seed, std::optional<std::uint64_t> own) {
    SimulationOptions options;
    options.seed = seed;
    Simulation simulation(options);
    MassSpringMotion motion;
    motion.random_speed = 1;
    motion.seed = own;
    std::vector<Vec3d> result;
    for (int i = 0; i < 5; ++i) {
      const ObjectId id = simulation.add(make_icosphere(1), {}, motion);
      result.push_back(simulation.body(id)->velocities()[0]);
    }
    return result;
  };
  const std::vector<Vec3d> first = velocities(1, std::nullopt);
  EXPECT_EQ(first, velocities(1, std::nullopt));
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_NEAR(norm(first[i]), 1, 1e-14);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(first[i], first[j]);
    EXPECT_NE(first[i], velocities(2, std::nullopt)[i]);
  }
  EXPECT_EQ(velocities(1, 3), std::vector<Vec3d>(5, first[3]));
}

TEST(Simulation, TheBorderTurnsBackAndTakesNoSpeed) {
  const SimulationOptions options = in_a_room(1.2, ContactKinds::none);
  Simulation simulation = room_of_bodies(options);
  const double overshoot = 1.0 * options.time_step;
  int turns = 0;
  std::vector<Vec3d> before;
  for (int step = 0; step < 2000; ++step) {
    simulation.step();
    const std::vector<ObjectId> ids = objects_of(simulation);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const MassSpringBody& body = *simulation.body(ids[i]);
      const Vec3d velocity = body.mean_velocity();
      ASSERT_NEAR(norm(velocity), simulation.time() > 0.201 ? 1 : norm(velocity), 1e-9);
      // An oscillating shape may extend a little beyond the border.
      const Aabb box = SceneInspector(simulation.scene()).bounds(ids[i]);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_GT(box.min[axis], -1.2 - overshoot - 0.05);
        ASSERT_LT(box.max[axis], 1.2 + overshoot + 0.05);
      }
      if (step > 50 && (velocity.x > 0) != (before[i].x > 0)) ++turns;
      before.resize(ids.size());
      before[i] = velocity;
    }
  }
  EXPECT_GT(turns, 20);
}

TEST(Simulation, ObjectsOutsideTheBorderComeBackAndLargeOnesStay) {
  SimulationOptions options = in_a_room(0.5, ContactKinds::none);
  Simulation simulation(options);
  MassSpringMotion motion = springy();
  motion.velocity = {1, 0, 0};
  const ObjectId outside = simulation.add(placed(make_icosphere(1), 0.2, {2, 0, 0}), {}, motion);
  const ObjectId large = simulation.add(placed(make_icosphere(1), 3, {0, 0, 0}), {}, motion);
  for (int step = 0; step < 200; ++step) {
    simulation.step();
    EXPECT_LT(std::fabs(simulation.body(large)->center_of_mass().x), 0.02);
  }
  const double x = simulation.body(outside)->center_of_mass().x;
  EXPECT_LT(std::fabs(x), 0.35);
}

TEST(Simulation, GravityDoesNotPressThroughTheBorder) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::symplectic_euler}) {
    for (const double air_friction : {0.0, 0.05}) {
      Simulation simulation(in_a_room(1, ContactKinds::none));
      MassSpringMotion motion = springy();
      motion.springs.integrator = integrator;
      motion.springs.gravity = {0, 0, 9.81};
      motion.springs.air_friction = air_friction;
      const ObjectId id = simulation.add(placed(make_icosphere(1), 0.2, {}), {}, motion);
      for (int step = 0; step < 3000; ++step) simulation.step();
      EXPECT_LT(simulation.body(id)->center_of_mass().z, 0.835);
      EXPECT_GT(simulation.body(id)->center_of_mass().z, air_friction > 0 ? 0.82 : -0.9);
    }
  }
}

TEST(Simulation, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto run = [](std::uint32_t threads) {
    SimulationOptions options = in_a_room(0.9);
    options.scene.threads = threads;
    Simulation simulation = room_of_bodies(options, 2);
    // Enough vertices to use all threads.
    simulation.add(placed(make_cloth(100, 100), 0.2, {0.5, 0.5, 0.5}), {}, springy());
    std::vector<Contact> contacts;
    for (int step = 0; step < 40; ++step) {
      const DetectResult& result = simulation.step();
      contacts.insert(contacts.end(), result.contacts.begin(), result.contacts.end());
    }
    EXPECT_GT(contacts.size(), 100u);
    return std::pair(state_of(simulation), contacts);
  };
  const auto one = run(1);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(3), one);
}

TEST(Simulation, GivesTheSameContactsByAnyBroadPhase) {
  const auto run = [](BroadPhaseMethod method, BoundingVolume volume) {
    SimulationOptions options = in_a_room(0.9);
    options.scene.broad_phase = method;
    options.scene.bounding_volume = volume;
    Simulation simulation = room_of_bodies(options, 3);
    std::vector<Contact> contacts;
    for (int step = 0; step < 100; ++step) {
      const DetectResult& result = simulation.step();
      contacts.insert(contacts.end(), result.contacts.begin(), result.contacts.end());
    }
    return contacts;
  };
  const auto expected = run(BroadPhaseMethod::brute, BoundingVolume::aabb);
  EXPECT_GT(expected.size(), 100u);
  EXPECT_EQ(run(BroadPhaseMethod::octree, BoundingVolume::aabb), expected);
  EXPECT_EQ(run(BroadPhaseMethod::automatic, BoundingVolume::aabb), expected);
  EXPECT_EQ(run(BroadPhaseMethod::grid, BoundingVolume::aabb), expected);
  EXPECT_EQ(run(BroadPhaseMethod::sweep, BoundingVolume::aabb), expected);
  EXPECT_EQ(run(BroadPhaseMethod::sweep3, BoundingVolume::aabb), expected);
  EXPECT_EQ(run(BroadPhaseMethod::octree, BoundingVolume::sphere), expected);
}

TEST(Simulation, ObjectsAtRestCostNothing) {
  Simulation simulation;
  simulation.add(make_icosphere(1), {.is_static = true});
  simulation.add(placed(make_icosphere(1), 1, {5, 0, 0}));
  const ObjectId put = simulation.add(placed(make_icosphere(1), 1, {0, 5, 0}));
  simulation.add(placed(make_icosphere(1), 1, {0, 0, 5}), {}, springy());
  simulation.step();
  EXPECT_EQ(simulation.step().stats.objects_refitted, 1u);
  simulation.set_positions(put, make_icosphere(1).positions);
  EXPECT_EQ(simulation.step().stats.objects_refitted, 2u);
  EXPECT_EQ(simulation.step().stats.objects_refitted, 1u);
}

TEST(Simulation, ContinuousContactsSeeTheWholeWay) {
  SimulationOptions options;
  options.scene.contacts = ContactKinds::continuous;
  options.time_step = 1;
  Simulation simulation(options);
  const ObjectId wall = simulation.add(make_icosphere(1), {.name = "wall"});
  MassSpringMotion motion = springy();
  motion.velocity = {4, 0, 0};
  motion.springs.stiffness = motion.springs.damping = 0;
  const ObjectId body = simulation.add(placed(make_icosphere(1), 0.25, {-2, 0, 0}), {}, motion);
  simulation.add(placed(make_icosphere(1), 0.25, {0, -2, 0}), {}, [](double, std::span<Vec3d> positions) {
    for (Vec3d& p : positions) p.y += 4;
  });
  const DetectResult& passed = simulation.step();
  std::set<ObjectPair> pairs;
  for (const ContinuousContact& c : passed.continuous_contacts) pairs.insert({c.object_a, c.object_b});
  EXPECT_EQ(pairs.size(), 3u);
  EXPECT_TRUE(verify(simulation.scene()).agrees());

  // At the end positions the bodies touch nothing.
  EXPECT_TRUE(simulation.detect().continuous_contacts.empty());
  EXPECT_EQ(simulation.step_count(), 1u);

  // After `set_positions`, the path of the body starts at the new place.
  simulation.set_positions(body, placed(make_icosphere(1), 0.25, {2, 0, 0}).positions);
  EXPECT_TRUE(simulation.detect().continuous_contacts.empty());
  for (const ContinuousContact& c : simulation.step().continuous_contacts)
    EXPECT_FALSE(c.object_a == wall && c.object_b == body);
}

TEST(Simulation, EventsBeginAndEndOnce) {
  Simulation simulation = room_of_bodies(in_a_room(0.8), 3);
  std::set<ObjectPair> touching;
  std::size_t begun = 0;
  for (int step = 0; step < 200; ++step) {
    const DetectResult& result = simulation.step();
    for (const ObjectPair& pair : result.contact_events.begin) EXPECT_TRUE(touching.insert(pair).second);
    for (const ObjectPair& pair : result.contact_events.end) EXPECT_EQ(touching.erase(pair), 1u);
    begun += result.contact_events.begin.size();
    std::set<ObjectPair> now;
    for (const ContactGroup& group : result.groups) now.insert({group.a, group.b});
    EXPECT_EQ(touching, now);
    EXPECT_EQ(result.step, simulation.step_count() - 1);
  }
  EXPECT_GT(begun, 20u);
}

TEST(Simulation, ObjectsComeAndGoBetweenSteps) {
  Simulation simulation = room_of_bodies(in_a_room(0.8), 2);
  for (int step = 0; step < 40; ++step) simulation.step();
  const ObjectId first = objects_of(simulation)[2];
  const Points kept = copied(simulation.positions(objects_of(simulation)[3]));
  simulation.remove(first);
  EXPECT_EQ(copied(simulation.positions(objects_of(simulation)[2])), kept);
  simulation.step();
  const ObjectId second = simulation.add(make_icosphere(2), {}, springy());
  EXPECT_EQ(second.index, first.index);
  EXPECT_NE(second.generation, first.generation);
  EXPECT_THROW(simulation.body(first), Error);
  for (int step = 0; step < 10; ++step) simulation.step();
  EXPECT_EQ(SceneInspector(simulation.scene()).validate(), "");
  EXPECT_TRUE(verify(simulation.scene()).agrees());
}

TEST(Simulation, BodiesPutElsewhereKeepTheirVelocities) {
  Simulation simulation;
  MassSpringMotion motion = springy();
  motion.velocity = {1, 2, 3};
  const ObjectId body = simulation.add(make_icosphere(1), {}, motion);
  const ObjectId still = simulation.add(make_icosphere(1));
  const ObjectId fast = simulation.add(make_icosphere(1), {.is_static = true});
  const Points there = placed(make_icosphere(1), 1, {5, 5, 5}).positions;
  simulation.set_positions(body, there);
  simulation.set_positions(still, there);
  EXPECT_EQ(copied(simulation.positions(body)), there);
  EXPECT_EQ(copied(simulation.positions(still)), there);
  EXPECT_EQ(simulation.body(body)->velocities()[0], (Vec3d{1, 2, 3}));
  EXPECT_EQ(simulation.detect().contact_events.begin.size(), 1u);
  EXPECT_THROW(simulation.set_positions(body, {}), Error);
  EXPECT_THROW(simulation.set_positions(still, {}), Error);
  EXPECT_THROW(simulation.set_positions(fast, there), Error);
  EXPECT_EQ(copied(simulation.positions(still)), there);
}

TEST(Simulation, HandlesPullAndThenHold) {
  SimulationOptions options;
  options.time_step = 0.01;
  Simulation simulation(options);
  const TriangleMesh cloth = make_cloth(4, 4);
  MassSpringMotion motion = springy();
  motion.springs.fixed_vertices = {0};
  motion.springs.substeps = 3;
  // Neither duration is a whole number of steps.
  motion.handles = {{{24, 23}, {0.5, 0, 0.25}, 0.105}, {{4}, {0, 1, 0}, 0.033}};
  const ObjectId id = simulation.add(cloth, {}, motion);
  EXPECT_EQ(simulation.body(id)->options().fixed_vertices, (std::vector<std::uint32_t>{0, 4, 23, 24}));
  for (int step = 1; step <= 20; ++step) {
    simulation.step();
    const double part = std::min(step * 0.01 / 0.105, 1.0), other = std::min(step * 0.01 / 0.033, 1.0);
    for (const std::uint32_t v : {23u, 24u}) {
      const Vec3d expected = cloth.positions[v] + part * Vec3d{0.5, 0, 0.25};
      EXPECT_LT(norm(simulation.positions(id)[v] - expected), 1e-12);
    }
    EXPECT_LT(norm(simulation.positions(id)[4] - cloth.positions[4] - other * Vec3d{0, 1, 0}), 1e-12);
    EXPECT_EQ(simulation.positions(id)[0], cloth.positions[0]);
  }
  EXPECT_EQ(simulation.body(id)->velocities()[24], Vec3d{});
  EXPECT_GT(norm(simulation.positions(id)[18] - cloth.positions[18]), 0.01);
}

TEST(Simulation, ReportsWhatTheUserWroteThatIsNotFinite) {
  Simulation simulation;
  const ObjectId id = simulation.add(make_icosphere(1), {}, [](double seconds, std::span<Vec3d> positions) {
    positions[5].z = seconds > 0.015 ? not_a_number : 0;
  });
  EXPECT_TRUE(simulation.step().non_finite_vertices.empty());
  const auto reported = simulation.step().non_finite_vertices;
  ASSERT_EQ(reported.size(), 1u);
  EXPECT_EQ(reported[0].object, id);
  EXPECT_EQ(reported[0].vertex, 5u);
}

/// A body that changing forces bend stays at its speed and does not begin to spin.
TEST(Simulation, ForcesThatChangeBendABodyWithoutMovingIt) {
  Simulation simulation(in_a_room(1000, ContactKinds::none));
  MassSpringMotion motion = springy();
  motion.springs.area_stiffness = 200;
  motion.random_speed = 0.5;
  motion.random_force = 0.3;
  motion.force_change_seconds = 0.4;
  motion.deform_seconds = 0.2;
  const ObjectId id = simulation.add(make_icosphere(3), {}, motion);
  const MassSpringBody& body = *simulation.body(id);
  const double size = norm(body.positions()[0] - body.center_of_mass());
  double mean_strain = 0;
  for (int step = 0; step < 2000; ++step) {
    simulation.step();
    mean_strain += body.edge_strain().mean / 2000;
  }
  EXPECT_GT(mean_strain, 0.01);
  EXPECT_GT(body.edge_strain().mean, 0.005) << "it bends until the end";
  EXPECT_NEAR(norm(body.mean_velocity()), 0.5, 1e-9);
  const double mass = 0.1 * static_cast<double>(body.vertex_count());
  const Vec3d spin = body.angular_momentum() - mass * cross(body.center_of_mass(), body.mean_velocity());
  EXPECT_LT(norm(spin), 0.02 * mass * size * size) << "less than a fiftieth of a radian per second";
}

TEST(Simulation, BodiesKnowTheirBounds) {
  const TriangleMesh mesh = make_torus(60, 40);  // two blocks of vertices
  MassSpringOptions springs = springy().springs;
  springs.substeps = 3;
  MassSpringBody body(mesh, springs);
  body.add_drift({1, 2, 3});
  const auto check = [&] {
    std::array<Vec3d, 2> expected{body.positions()[0], body.positions()[0]};
    for (const Vec3d& p : body.positions()) {
      for (int axis = 0; axis < 3; ++axis) {
        expected[0][axis] = std::min(expected[0][axis], p[axis]);
        expected[1][axis] = std::max(expected[1][axis], p[axis]);
      }
    }
    EXPECT_EQ(body.bounds(), expected);
  };
  check();
  for (int step = 0; step < 5; ++step) {
    body.step(0.01);
    check();
  }
  body.undo_step();
  check();
  body.set_positions(Points(mesh.positions.size(), Vec3d{1, 2, 3}));
  check();
  TriangleMesh broken = mesh;
  broken.positions[7].x = not_a_number;
  EXPECT_FALSE(MassSpringBody(broken, springs).bounds().has_value());
}

TEST(Simulation, FusedRefitFindsTheSame) {
  for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere}) {
    SimulationOptions options = in_a_room(1.5);
    options.scene.bounding_volume = volume;
    options.scene.comparison.lazy_refit = true;
    SimulationOptions fused_options = options;
    fused_options.fused_refit = true;
    Simulation plain(options), fused(fused_options);
    for (const double x : {-0.5, 0.0, 0.5}) {
      MassSpringMotion motion = springy();
      motion.random_speed = 1;
      motion.random_force = 0.2;
      motion.force_change_seconds = 0.5;
      const TriangleMesh mesh = placed(make_icosphere(3), 0.4, {x, 0, 0});
      plain.add(mesh, {}, motion);
      fused.add(mesh, {}, motion);
    }
    std::size_t contacts = 0;
    for (int step = 0; step < 200; ++step) {
      EXPECT_EQ(hash_of(fused.step()), hash_of(plain.step())) << step;
      contacts += plain.scene().result().contacts.size();
    }
    EXPECT_GT(contacts, 100u);
    options.scene.comparison.lazy_refit = false;
    options.fused_refit = true;
    EXPECT_THROW(Simulation{options}, Error);
  }
}

}  // namespace supple::simulation_test
