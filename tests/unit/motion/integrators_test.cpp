// Tests how errors decrease with the step, and which steps are stable.

#include <gtest/gtest.h>

#include "supple/error.hpp"
#include "support/bodies.hpp"

namespace supple::integrators_test {

std::vector<Vec3d> after_a_second(Integrator integrator, int steps, double volume_stiffness) {
  const TriangleMesh mesh = make_icosphere(1);
  MassSpringBody body(mesh, {.integrator = integrator,
                             .stiffness = 20,
                             .damping = 0.8,
                             .air_friction = 0.3,
                             .bending_stiffness = 4,
                             .area_stiffness = 10,
                             .volume_stiffness = volume_stiffness,
                             .gravity = {0, -2, 0},
                             .fixed_vertices = {0}});
  body.set_positions(deformed(mesh, 0.15, 0.05, 4));
  body.set_velocities(random_vectors(mesh.positions.size(), 0.5, 5));
  body.add_drift({0.5, 0, 0});
  run(body, 1, steps);
  return {body.positions().begin(), body.positions().end()};
}

TEST(ConvergenceOrder, IsTwoOfVerletAndOneOfBothKindsOfEuler) {
  for (const double volume_stiffness : {0.0, 30.0}) {
    const std::vector<Vec3d> exact = after_a_second(Integrator::verlet, 8192, volume_stiffness);
    for (const Integrator integrator : all_integrators) {
      const double expected = integrator == Integrator::verlet ? 2 : 1;
      const int coarsest = integrator == Integrator::verlet ? 64 : 256;
      double before = 0;
      for (int steps = coarsest; steps <= 4 * coarsest; steps *= 2) {
        const double error = largest_difference(after_a_second(integrator, steps, volume_stiffness), exact);
        if (before > 0) {
          EXPECT_NEAR(std::log2(before / error), expected, 0.1) << steps << " steps";
        }
        before = error;
      }
    }
  }
}

MassSpringBody stiff_sphere(Integrator integrator, double stiffness) {
  const TriangleMesh mesh = make_icosphere(2);
  MassSpringBody body(mesh, {.integrator = integrator, .stiffness = stiffness, .damping = 0});
  body.set_positions(deformed(mesh, 0.1, 0.01, 6));
  return body;
}

TEST(StableStep, IsWhereExplicitIntegratorsStopGrowing) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::symplectic_euler}) {
    for (const double damping : {0.0, 2.0, 20.0}) {
      const TriangleMesh mesh = make_icosphere(2);
      const auto energy_after = [&](double part_of_stable) {
        MassSpringBody body(mesh, {.integrator = integrator, .damping = damping, .air_friction = 1});
        body.set_positions(deformed(mesh, 0.001, 0.001, 7));
        const double before = body.energy().total();
        for (int i = 0; i < 400; ++i) body.step(part_of_stable * body.stable_step());
        return body.energy().total() / before;
      };
      EXPECT_LT(energy_after(0.99), 2);
      EXPECT_ANY_THROW(EXPECT_GT(energy_after(2.5), 1e6); throw 0) << damping;
    }
  }
}

TEST(StableStep, CountsSubstepsAndIsInfiniteForBackwardEuler) {
  const TriangleMesh mesh = make_icosphere(1);
  const double of_one = MassSpringBody(mesh).stable_step();
  EXPECT_EQ(MassSpringBody(mesh, {.substeps = 4}).stable_step(), 4 * of_one);
  EXPECT_TRUE(std::isinf(MassSpringBody(mesh, {.integrator = Integrator::backward_euler}).stable_step()));
  // For one spring, ω² = 2 k/m, and the limit of Verlet is h ω = 2.
  EXPECT_NEAR(MassSpringBody(one_spring(1), {.stiffness = 8, .damping = 0}).stable_step(), 0.5, 1e-15);
}

TEST(Stiffness, StopsVerletButNotBackwardEuler) {
  // k h² / m = 10⁶
  const double step = 0.01, stiffness = 1e10;
  auto explicit_body = stiff_sphere(Integrator::verlet, stiffness);
  EXPECT_THROW(run(explicit_body, 1, 100), Error);
  auto implicit_body = stiff_sphere(Integrator::backward_euler, stiffness);
  double energy = implicit_body.energy().total();
  for (int i = 0; i < 100; ++i) {
    implicit_body.step(step);
    EXPECT_LE(implicit_body.energy().total(), energy * (1 + 1e-9));
    energy = implicit_body.energy().total();
  }
  const auto rest = make_icosphere(2).positions;
  EXPECT_LT(largest_difference(implicit_body.positions(), rest), 0.3);
  EXPECT_LT(energy, 1e-6 * stiff_sphere(Integrator::verlet, stiffness).energy().total());
}

TEST(Stiffness, OfASheetThatFallsIsNoHarm) {
  const TriangleMesh cloth = make_cloth(8, 8);
  MassSpringBody body(cloth, {.integrator = Integrator::backward_euler,
                              .stiffness = 1e8,
                              .bending_stiffness = 1e3,
                              .area_stiffness = 1e6,
                              .gravity = {0, -10, 0},
                              .fixed_vertices = {0, 8}});
  for (int i = 0; i < 30; ++i) {
    body.step(0.1);
    EXPECT_LT(body.area_error().largest, 0.01);
  }
  EXPECT_LT(body.center_of_mass().y, -0.2);
}

TEST(BlowUp, PutsTheStateBackAndNamesVertexAndStep) {
  const TriangleMesh mesh = make_icosphere(1);
  for (const std::uint32_t substeps : {1u, 2u, 5u}) {
    MassSpringBody body(mesh, {.substeps = substeps, .stiffness = 1e8, .yield_strain = 0.05});
    body.set_positions(deformed(mesh, 0.2, 0, 8));
    std::vector<Vec3d> positions, velocities;
    std::vector<MassSpringBody::Spring> springs;
    try {
      for (int i = 0; i < 100; ++i) {
        positions.assign(body.positions().begin(), body.positions().end());
        velocities.assign(body.velocities().begin(), body.velocities().end());
        springs = body.springs();
        body.step(0.01);
      }
      FAIL() << "it is stable";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("vertex "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("steps below "), std::string::npos) << error.what();
    }
    EXPECT_EQ(std::vector<Vec3d>(body.positions().begin(), body.positions().end()), positions);
    EXPECT_EQ(std::vector<Vec3d>(body.velocities().begin(), body.velocities().end()), velocities);
    for (std::size_t i = 0; i < springs.size(); ++i) {
      EXPECT_EQ(body.springs()[i].rest_length, springs[i].rest_length);
    }
  }
}

TEST(BlowUp, IsWhatNumbersThatAreNotFiniteAre) {
  const TriangleMesh mesh = make_icosphere(1);
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  for (const Integrator integrator : all_integrators) {
    for (const double bad : {nan, infinity}) {
      MassSpringBody body(mesh, {.integrator = integrator});
      std::vector<Vec3d> values(mesh.positions.size());
      values[7].y = bad;
      body.set_external_forces(values);
      EXPECT_THROW(body.step(0.01), Error);
      body.set_external_forces({});
      body.step(0.01);
      body.set_velocities(values);
      EXPECT_THROW(body.step(0.01), Error);
      body.set_velocities(std::vector<Vec3d>(mesh.positions.size()));
      values = mesh.positions;
      values[3].z = bad;
      body.set_positions(values);
      EXPECT_THROW(body.step(0.01), Error);
      body.set_positions(mesh.positions);
      body.step(0.01);
      EXPECT_LT(largest_difference(body.positions(), mesh.positions), 1e-12);
    }
  }
}

TEST(Steps, MustBeFiniteAndAboveZero) {
  MassSpringBody body(make_icosphere(1));
  for (const double seconds :
       {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(body.step(seconds), Error);
  }
}

TEST(Substeps, AreThatManySteps) {
  const TriangleMesh mesh = make_icosphere(2);
  MassSpringBody whole(mesh, {.substeps = 4}), parts(mesh);
  for (MassSpringBody* body : {&whole, &parts}) body->set_positions(deformed(mesh, 0.2, 0.05, 9));
  for (int i = 0; i < 10; ++i) whole.step(0.0625);
  for (int i = 0; i < 40; ++i) parts.step(0.015625);
  EXPECT_EQ(largest_difference(whole.positions(), parts.positions()), 0);
}

}  // namespace supple::integrators_test
