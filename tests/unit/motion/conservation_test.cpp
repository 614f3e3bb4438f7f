// Checks conserved quantities.

#include <gtest/gtest.h>

#include "support/bodies.hpp"

namespace supple::conservation_test {

/// Relative errors of the energy of a freely oscillating sphere: the largest one, and the drift from the mean
/// of the first quarter to the mean of the last.
struct EnergyError {
  double largest = 0, drift = 0;
};

EnergyError energy_error(Integrator integrator, double step, int steps, double volume_stiffness = 0) {
  const TriangleMesh mesh = make_icosphere(2);
  MassSpringBody body(mesh, {.integrator = integrator,
                             .damping = 0,
                             .bending_stiffness = 5,
                             .area_stiffness = 20,
                             .volume_stiffness = volume_stiffness});
  body.set_positions(deformed(mesh, 0.2, 0.02, 1));
  const double before = body.energy().total();
  EnergyError error;
  for (int i = 0; i < steps; ++i) {
    body.step(step);
    const double relative = body.energy().total() / before - 1;
    error.largest = std::max(error.largest, std::abs(relative));
    if (i < steps / 4) error.drift -= relative / (steps / 4);
    if (i >= steps - steps / 4) error.drift += relative / (steps / 4);
  }
  return error;
}

TEST(Energy, OfVerletSwingsButDoesNotDrift) {
  const EnergyError coarse = energy_error(Integrator::verlet, 0.02, 4000);
  EXPECT_LT(coarse.largest, 0.02);
  EXPECT_LT(std::abs(coarse.drift), 2e-4);
  const EnergyError fine = energy_error(Integrator::verlet, 0.01, 4000);
  EXPECT_NEAR(coarse.largest / fine.largest, 4, 0.8) << "second order";
}

TEST(Energy, OfVerletIsKeptByVolumesToo) {
  const EnergyError coarse = energy_error(Integrator::verlet, 0.02, 2000, 100);
  EXPECT_LT(coarse.largest, 0.05);
  EXPECT_LT(std::abs(coarse.drift), 1e-3);
  const EnergyError fine = energy_error(Integrator::verlet, 0.01, 4000, 100);
  EXPECT_NEAR(coarse.largest / fine.largest, 4, 1) << "second order";
}

TEST(Energy, OfSymplecticEulerDoesNotDrift) {
  const EnergyError error = energy_error(Integrator::symplectic_euler, 0.01, 4000);
  EXPECT_LT(error.largest, 0.1);
  EXPECT_LT(std::abs(error.drift), 2e-3);
}

TEST(Energy, OfBackwardEulerNeverGrows) {
  const TriangleMesh mesh = make_icosphere(2);
  MassSpringBody body(mesh, {.integrator = Integrator::backward_euler, .damping = 0, .area_stiffness = 20});
  body.set_positions(deformed(mesh, 0.2, 0.02, 1));
  double before = body.energy().total();
  for (int i = 0; i < 60; ++i) {
    body.step(0.05);
    EXPECT_LT(body.energy().total(), before * (1 + 1e-12));
    before = body.energy().total();
  }
}

TEST(Energy, DampingOnlyTakesIt) {
  const TriangleMesh mesh = make_icosphere(2);
  MassSpringBody body(mesh, {.damping = 0.2});
  body.set_positions(deformed(mesh, 0.2, 0.02, 1));
  const double at_first = body.energy().total();
  double before = at_first;
  for (int second = 0; second < 20; ++second) {
    run(body, 1, 100);
    EXPECT_LT(body.energy().total(), before);
    before = body.energy().total();
  }
  EXPECT_LT(before, 0.1 * at_first);
}

struct Kind {
  const char* name;
  MassSpringOptions options;
};
/// GoogleTest calls this function; ctest shows the name.
void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

class Momentum : public testing::TestWithParam<Kind> {};

TEST_P(Momentum, IsKeptToRounding) {
  const MassSpringOptions& options = GetParam().options;
  const TriangleMesh mesh = make_torus(8, 5);
  MassSpringBody body(mesh, options);
  body.set_positions(deformed(mesh, 0.3, 0.03, 2));
  body.set_velocities(random_vectors(mesh.positions.size(), 0.5, 3));
  body.add_drift({0.5, 0.25, -1});
  const Vec3d momentum = body.momentum(), angular = body.angular_momentum(), start = body.center_of_mass();
  const double mass = options.vertex_mass * static_cast<double>(body.vertex_count());
  run(body, 2, options.integrator == Integrator::backward_euler ? 40 : 400);
  const double scale = mass;  // velocities and distances are about 1
  EXPECT_LT(norm(body.momentum() - momentum), 1e-13 * scale);
  if (options.integrator != Integrator::backward_euler) {
    EXPECT_LT(norm(body.angular_momentum() - angular), 1e-12 * scale);
  }
  EXPECT_LT(norm(body.center_of_mass() - (start + momentum * (2 / mass))), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Momentum,
    testing::Values(
        Kind{"Verlet", {.vertex_mass = 0.5, .bending_stiffness = 9, .area_stiffness = 30}},
        Kind{"SymplecticEuler",
             {.integrator = Integrator::symplectic_euler, .bending_stiffness = 9, .area_stiffness = 30}},
        Kind{"BackwardEuler",
             {.integrator = Integrator::backward_euler, .bending_stiffness = 9, .area_stiffness = 30}},
        Kind{"VerletVolume", {.vertex_mass = 0.5, .bending_stiffness = 9, .volume_stiffness = 200}},
        Kind{"SymplecticEulerVolume", {.integrator = Integrator::symplectic_euler, .volume_stiffness = 200}},
        Kind{"BackwardEulerVolume", {.integrator = Integrator::backward_euler, .volume_stiffness = 1e6}},
        Kind{"StiffBackwardEuler", {.integrator = Integrator::backward_euler, .stiffness = 1e9}},
        Kind{"Limited", {.max_strain = 0.1}},
        Kind{"LimitedSymplecticEuler", {.integrator = Integrator::symplectic_euler, .max_strain = 0.1}},
        Kind{"Plastic", {.area_stiffness = 30, .yield_strain = 0.05}},
        Kind{"LimitedPlastic", {.max_strain = 0.1, .yield_strain = 0.05}}),
    [](const auto& kind) { return kind.param.name; });

}  // namespace supple::conservation_test
