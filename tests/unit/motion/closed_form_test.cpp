// Compares motions with known formulas.

#include <gtest/gtest.h>

#include "support/bodies.hpp"

namespace supple::closed_form_test {

constexpr double pi = 3.14159265358979323846;

double length_of(const MassSpringBody& body) {
  return norm(body.positions()[1] - body.positions()[0]);
}
double rate_of(const MassSpringBody& body) {
  return body.velocities()[1].x - body.velocities()[0].x;
}

MassSpringBody stretched_spring(const MassSpringOptions& options, double by) {
  MassSpringBody body(one_spring(2), options);
  body.set_positions(one_spring(2 + by).positions);
  return body;
}

TEST(OneSpring, SwingsWithThePeriodOfItsReducedMass) {
  // r'' = -2 k/m (r - s)
  const double k = 7, m = 0.5, by = 0.3, frequency = std::sqrt(2 * k / m), period = 2 * pi / frequency;
  auto body = stretched_spring({.vertex_mass = m, .stiffness = k, .damping = 0}, by);
  run(body, 0.25 * period, 1000);
  EXPECT_NEAR(length_of(body), 2, 1e-6 * by);
  EXPECT_NEAR(rate_of(body), -by * frequency, 1e-6 * by * frequency);
  run(body, 0.25 * period, 1000);
  EXPECT_NEAR(length_of(body), 2 - by, 1e-6 * by);
  run(body, 1.5 * period, 6000);
  EXPECT_NEAR(length_of(body), 2 + by, 1e-6 * by);
  EXPECT_NEAR(body.energy().total(), 0.5 * k * by * by, 1e-6 * k * by * by);
}

TEST(OneSpring, DampingAlongItShrinksTheSwingAsItShould) {
  // r'' = -2 k/m (r - s) - 2 k_d/m r', so r = s + by e^(-γt) (cos ωt + γ/ω sin ωt)
  const double k = 7, m = 0.5, damping = 0.4, by = 0.3, decay = damping / m;
  const double frequency = std::sqrt(2 * k / m - decay * decay), period = 2 * pi / frequency;
  for (const Integrator integrator : all_integrators) {
    auto body = stretched_spring(
        {.integrator = integrator, .vertex_mass = m, .stiffness = k, .damping = damping}, by);
    run(body, period, 4000);
    const double tolerance = integrator == Integrator::verlet ? 1e-6 : 5e-3;
    EXPECT_NEAR(length_of(body), 2 + by * std::exp(-decay * period), tolerance * by);
  }
}

TEST(OneSpring, DampingActsOnlyAlongIt) {
  MassSpringBody body(one_spring(2), {.stiffness = 0, .damping = 5});
  body.set_velocities(std::vector<Vec3d>{{0, 1, 0}, {0, -1, 0}});
  const double step = 1e-9;
  body.step(step);
  EXPECT_NEAR(body.velocities()[0].y, 1, 1e-7);
  body.set_positions(one_spring(2).positions);
  body.set_velocities(std::vector<Vec3d>{{1, 0, 0}, {-1, 0, 0}});
  body.step(step);
  EXPECT_NEAR((1 - body.velocities()[0].x) / step, 10, 1e-5) << "2 m/s times 5 N s/m on 1 kg";
}

TEST(FreeFlight, IsExact) {
  const TriangleMesh box = make_box({1, 1, 1}, 2);
  const Vec3d velocity{1, -2, 0.5};
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(box, {.integrator = integrator, .bending_stiffness = 3, .area_stiffness = 4});
    body.set_velocities(std::vector<Vec3d>(box.positions.size(), velocity));
    run(body, 2, 128);
    for (std::size_t v = 0; v < box.positions.size(); ++v) {
      EXPECT_LE(norm(body.positions()[v] - (box.positions[v] + 2.0 * velocity)),
                integrator == Integrator::backward_euler ? 1e-13 : 0);
    }
  }
}

TEST(FreeFall, FollowsTheParabolaOfItsIntegrator) {
  const TriangleMesh box = make_box({1, 1, 1}, 2);
  constexpr int steps = 64;
  const double h = 1.0 / 64, g = -8;
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(box, {.integrator = integrator, .gravity = {0, g, 0}});
    run(body, 1, steps);
    // Both kinds of Euler advance each step with its end velocity: g h² (1 + 2 + … + n).
    const double way = integrator == Integrator::verlet ? 0.5 * g : g * h * h * steps * (steps + 1) / 2;
    const double tolerance = integrator == Integrator::backward_euler ? 1e-12 : 0;
    EXPECT_NEAR(body.center_of_mass().y, way, tolerance);
    EXPECT_NEAR(body.mean_velocity().y, g, tolerance);
    EXPECT_NEAR(body.energy().total(), static_cast<double>(body.vertex_count()) * (0.5 * g * g - g * way),
                1e-9);
  }
}

TEST(AirFriction, SlowsDownExponentiallyTowardsTheAir) {
  MassSpringBody body(one_spring(1), {.vertex_mass = 2, .air_friction = 3});
  body.set_velocities(std::vector<Vec3d>(2, {4, 0, 0}));
  run(body, 1, 1000);
  EXPECT_NEAR(body.mean_velocity().x, 4 * std::exp(-1.5), 1e-5);
  body.add_drift({0, 1, 0});
  run(body, 20, 1000);
  EXPECT_NEAR(body.mean_velocity().x, 0, 1e-9);
  EXPECT_EQ(body.mean_velocity().y, 1) << "the air drifts with the body";
  body.reflect(1);
  EXPECT_EQ(body.mean_velocity().y, -1);
  run(body, 1, 10);
  EXPECT_EQ(body.mean_velocity().y, -1);
}

TEST(ExternalForces, HoldUntilSetAgain) {
  MassSpringBody body(one_spring(1), {.vertex_mass = 2, .stiffness = 0, .damping = 0});
  body.set_external_forces(std::vector<Vec3d>{{0, 6, 0}, {0, 0, 0}});
  run(body, 1, 4);
  EXPECT_EQ(body.velocities()[0].y, 3);
  EXPECT_EQ(body.velocities()[1].y, 0);
  body.set_external_forces({});
  run(body, 1, 4);
  EXPECT_EQ(body.velocities()[0].y, 3);
}

TEST(HangingChain, EachSpringBearsTheWeightBelow) {
  const std::uint32_t masses = 7;
  const double g = 9.81, m = 0.2, k = 60;
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(chain(masses, 0.5), {.integrator = integrator,
                                             .vertex_mass = m,
                                             .stiffness = k,
                                             .damping = 0.5,
                                             .air_friction = 0.5,
                                             .gravity = {0, -g, 0},
                                             .fixed_vertices = {0}});
    run(body, 30, 1500);
    for (std::uint32_t v = 0; v + 1 < masses; ++v) {
      const double below = m * g * (masses - 1 - v);
      EXPECT_NEAR(norm(body.positions()[v + 1] - body.positions()[v]), 0.5 + below / k, 1e-9) << v;
    }
    EXPECT_EQ(body.positions()[0], (Vec3d{0, 0, 0}));
    EXPECT_LT(body.energy().kinetic, 1e-18);
  }
}

TEST(Pendulum, SwingsWithItsPeriod) {
  // A stiff spring of length 1 with one end fixed; the period of small oscillations is 2π √(1/g) (1 + θ²/16).
  const double g = 9.81, angle = 0.01;
  MassSpringBody body(
      chain(2, 1),
      {.vertex_mass = 1, .stiffness = 1e6, .damping = 0, .gravity = {0, -g, 0}, .fixed_vertices = {0}});
  body.set_positions(std::vector<Vec3d>{{0, 0, 0}, {std::sin(angle), -std::cos(angle), 0}});
  run(body, 0.5 * pi * std::sqrt(1 / g) * (1 + angle * angle / 16), 2000);
  EXPECT_NEAR(body.positions()[1].x / angle, 0, 1e-4);
}

}  // namespace supple::closed_form_test
