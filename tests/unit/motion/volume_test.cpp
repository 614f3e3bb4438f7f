// Tests the force that preserves the volume of closed surfaces.

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "motion/network/closed_parts.hpp"
#include "supple/error.hpp"
#include "support/bodies.hpp"

namespace supple::volume_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void append(TriangleMesh& mesh, const TriangleMesh& other, Vec3d at) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3d& p : other.positions) mesh.positions.push_back(p + at);
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

std::vector<Vec3d> scaled(std::span<const Vec3d> positions, double factor) {
  std::vector<Vec3d> result(positions.begin(), positions.end());
  for (Vec3d& p : result) p = p * factor;
  return result;
}

/// Two balls, one of them with inward faces, and an open sheet.
TriangleMesh two_balls_and_a_sheet() {
  TriangleMesh mesh = make_icosphere(2);
  append(mesh, inside_out(make_icosphere(3)), {4, 0, 0});
  append(mesh, make_cloth(3, 3), {0, 4, 0});
  return mesh;
}

TEST(ClosedParts, AreTheClosedOnesOfAMesh) {
  const ClosedParts closed = closed_parts(two_balls_and_a_sheet());
  ASSERT_EQ(closed.parts.size(), 2u);
  EXPECT_EQ(closed.elements.size(), 20u * 4 + 20 * 9);
  EXPECT_GT(closed.parts[0].rest_volume, 3);
  EXPECT_LT(closed.parts[1].rest_volume, -3);
  EXPECT_TRUE(closed_parts(make_cloth(4, 4)).parts.empty());
  TriangleMesh hole = make_box({1, 1, 1}, 3);
  hole.triangles.pop_back();
  EXPECT_TRUE(closed_parts(hole).parts.empty());
  TriangleMesh turned = make_box({1, 1, 1}, 3);
  std::swap(turned.triangles[5][1], turned.triangles[5][2]);
  EXPECT_TRUE(closed_parts(turned).parts.empty()) << "one triangle has the wrong orientation";
  TriangleMesh spoilt = make_box({1, 1, 1}, 3);
  spoilt.triangles.push_back({3, 3, 7});
  EXPECT_EQ(closed_parts(spoilt).parts.size(), 1u);
  TriangleMesh touching = make_box({1, 1, 1}, 1);
  const std::uint32_t shared = touching.triangles[0][0];
  append(touching, make_box({1, 1, 1}, 1), {0.25, 0.5, 0});
  for (Triangle& t : touching.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      if (t[corner] == 8) t[corner] = shared;
    }
  }
  EXPECT_EQ(closed_parts(touching).parts.size(), 1u) << "they share a vertex";
}

TEST(Volume, IsThatOfSolids) {
  EXPECT_NEAR(MassSpringBody(make_box({1, 2, 3}, 3)).volume(), 6, 1e-14);
  EXPECT_NEAR(MassSpringBody(inside_out(make_box({1, 2, 3}, 3))).volume(), -6, 1e-14);
  TriangleMesh far = make_box({1, 2, 3}, 3);
  for (Vec3d& p : far.positions) p = p + Vec3d{1e6, -2e6, 3e6};
  EXPECT_NEAR(MassSpringBody(far).volume(), 6, 1e-8);
  EXPECT_NEAR(MassSpringBody(make_icosphere(24)).volume(), 4 * std::numbers::pi / 3, 0.02);
  EXPECT_EQ(MassSpringBody(make_cloth(3, 3)).volume(), 0);
  MassSpringBody twice(make_box({1, 2, 3}, 2));
  twice.set_positions(scaled(twice.positions(), 2));
  EXPECT_NEAR(twice.volume(), 48, 1e-13);
}

/// By symmetry, equal inward forces scale an icosahedron by the factor s with
/// -12 f = ∂E/∂r = (30 k a² (s - 1) + 3 K V s² (s³ - 1)) / r.
TEST(VolumeForce, BalancesPressureOnAnIcosahedron) {
  const TriangleMesh mesh = make_icosphere(1);
  const double edge = 1 / std::sin(0.4 * std::numbers::pi),
               volume = 5 * (3 + std::sqrt(5)) / 12 * std::pow(edge, 3);
  const double stiffness = 20, modulus = 60, inward = 5;
  double s = 1;
  for (int i = 0; i < 50; ++i) {
    const auto force = [&](double x) {
      return 12 * inward + 30 * stiffness * edge * edge * (x - 1) +
             3 * modulus * volume * x * x * (x * x * x - 1);
    };
    s -= force(s) * 2e-6 / (force(s + 1e-6) - force(s - 1e-6));
  }
  for (const bool is_turned : {false, true}) {
    for (const Integrator integrator : all_integrators) {
      MassSpringBody body(is_turned ? inside_out(mesh) : mesh, {.integrator = integrator,
                                                                .stiffness = stiffness,
                                                                .damping = 2,
                                                                .air_friction = 2,
                                                                .volume_stiffness = modulus});
      body.set_external_forces(scaled(mesh.positions, -inward));
      run(body, 20, 2000);
      EXPECT_LT(s, 0.97);
      for (const Vec3d& p : body.positions()) EXPECT_NEAR(norm(p), s, 1e-9);
      EXPECT_NEAR(body.volume(), (is_turned ? -1 : 1) * volume * s * s * s, 1e-8);
      EXPECT_NEAR(body.energy().volume, 0.5 * modulus * volume * std::pow(1 - s * s * s, 2), 1e-7);
    }
  }
}

/// Without springs, small radial oscillations of a ball with equivalent vertices have
/// ω² = 3 K V · 3 / (n m r²).
TEST(VolumeForce, LetsAnIcosahedronBreatheAtItsFrequency) {
  const TriangleMesh mesh = make_icosphere(1);
  MassSpringBody body(mesh, {.vertex_mass = 0.5, .stiffness = 0, .damping = 0, .volume_stiffness = 8});
  const double frequency = std::sqrt(9 * 8 * body.volume() / (12 * 0.5));
  body.set_positions(scaled(mesh.positions, 1 + 1e-5));
  run(body, 2 * std::numbers::pi / frequency, 4000);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    EXPECT_LT(norm(body.positions()[v] - mesh.positions[v] * (1 + 1e-5)), 1e-9);
  run(body, std::numbers::pi / frequency, 2000);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    EXPECT_LT(norm(body.positions()[v] - mesh.positions[v] * (1 - 1e-5)), 1e-9);
}

TEST(VolumeForce, IsTheNegativeGradientOfItsEnergy) {
  const TriangleMesh mesh = two_balls_and_a_sheet();
  MassSpringBody body(mesh, {.stiffness = 0, .damping = 0, .volume_stiffness = 7});
  std::vector<Vec3d> positions = deformed(mesh, 0.1, 0.1, 3);
  const double h = 1e-6;
  body.set_positions(positions);
  body.step(h);
  const std::vector<Vec3d> velocities(body.velocities().begin(), body.velocities().end());
  for (const std::uint32_t v : {0u, 20u, 41u, 42u, 100u, 133u, 134u, 140u}) {
    for (int axis = 0; axis < 3; ++axis) {
      const double at = positions[v][axis];
      std::array<double, 2> energy{};
      for (int side = 0; side < 2; ++side) {
        positions[v][axis] = at + (side == 0 ? -1e-5 : 1e-5);
        body.set_positions(positions);
        energy[side] = body.energy().volume;
      }
      positions[v][axis] = at;
      EXPECT_NEAR(velocities[v][axis] / h, -(energy[1] - energy[0]) / 2e-5, 1e-5) << v;
    }
  }
}

TEST(VolumeForce, KeepsEachPartForItself) {
  const TriangleMesh mesh = two_balls_and_a_sheet();
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(mesh,
                        {.integrator = integrator, .stiffness = 0, .damping = 0, .volume_stiffness = 50});
    std::vector<Vec3d> positions = mesh.positions;
    for (std::size_t v = 0; v < 42; ++v) positions[v] = positions[v] * 0.9;
    body.set_positions(positions);
    body.step(0.02);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (v < 42) {
        EXPECT_GT(dot(body.velocities()[v], mesh.positions[v]), 1e-3);
      } else {
        EXPECT_LT(norm(body.velocities()[v]), 1e-9);
      }
    }
  }
}

TEST(VolumeForce, IsIndependentOfThreads) {
  // The mesh spans several blocks, and its second part begins in the middle of a block.
  TriangleMesh mesh = make_icosphere(28);
  append(mesh, make_icosphere(20), {3, 0, 0});
  const auto after = [&](std::uint32_t threads) {
    MassSpringBody body(mesh, {.bending_stiffness = 5, .volume_stiffness = 200, .threads = threads});
    body.set_positions(deformed(mesh, 0.05, 0, 2));
    run(body, 0.02, 10);
    return std::vector<Vec3d>(body.positions().begin(), body.positions().end());
  };
  const auto one = after(1);
  EXPECT_EQ(after(2), one);
  EXPECT_EQ(after(3), one);
}

TEST(VolumeForce, IsRefusedWhereNothingIsClosed) {
  try {
    const MassSpringBody body(make_cloth(3, 3), {.volume_stiffness = 2});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("volume_stiffness is 2, but no part of the mesh is closed"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(MassSpringBody({}, {.volume_stiffness = 2}).volume(), 0);
}

TEST(VolumeForce, LeavesFlatPartsAlone) {
  // Two triangles back to back, a flat box, and a mesh with a NaN coordinate.
  const TriangleMesh back_to_back{"leaf", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}};
  const TriangleMesh flat = make_box({1, 1e-9, 1}, 2);
  TriangleMesh spoilt = make_icosphere(1);
  spoilt.positions[3].y = nan;
  for (const TriangleMesh& mesh : {back_to_back, flat, spoilt}) {
    for (const Integrator integrator : all_integrators) {
      MassSpringBody body(mesh, {.integrator = integrator, .volume_stiffness = 1e3});
      MassSpringBody without(mesh, {.integrator = integrator});
      EXPECT_EQ(body.stable_step(), without.stable_step());
      for (MassSpringBody* each : {&body, &without}) {
        std::vector<Vec3d> positions = deformed(mesh, 0.1, 0, 1);
        each->set_positions(positions);
        run(*each, 1, 20);
      }
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (is_finite(mesh.positions[v])) {
          EXPECT_LT(norm(body.positions()[v] - without.positions()[v]), 1e-12);
        }
      }
      EXPECT_TRUE(std::isfinite(body.volume()));
      EXPECT_EQ(body.energy().volume, 0);
    }
  }
}

TEST(VolumeForce, ShortensTheStableStepAsItShould) {
  const TriangleMesh mesh = make_icosphere(3);
  for (const Integrator integrator : {Integrator::verlet, Integrator::symplectic_euler}) {
    const auto energy_after = [&](double part_of_stable) {
      MassSpringBody body(mesh,
                          {.integrator = integrator, .stiffness = 1, .damping = 0, .volume_stiffness = 1e3});
      body.set_positions(scaled(mesh.positions, 1.0001));
      const double before = body.energy().total();
      for (int i = 0; i < 400; ++i) body.step(part_of_stable * body.stable_step());
      return body.energy().total() / before;
    };
    EXPECT_LT(energy_after(0.95), 11) << "the energy of Verlet oscillates by up to 1 / (1 - 0.95²)";
    EXPECT_ANY_THROW(EXPECT_GT(energy_after(1.2), 1e3); throw 0) << "the bound is sharp for a ball";
  }
}

TEST(VolumeForce, AtAnyStiffnessIsNoHarmToBackwardEuler) {
  const TriangleMesh mesh = two_balls_and_a_sheet();
  for (const double modulus : {1e2, 1e6, 1e10}) {
    MassSpringBody body(mesh, {.integrator = Integrator::backward_euler, .volume_stiffness = modulus});
    body.set_positions(deformed(mesh, 0.2, 0.05, 6));
    double before = body.energy().total();
    for (int i = 0; i < 30; ++i) {
      body.step(0.02);
      EXPECT_LE(body.energy().total(), before * (1 + 1e-9));
      before = body.energy().total();
    }
    if (modulus > 1e5) {
      EXPECT_NEAR(body.volume(), MassSpringBody(mesh).volume(), 1e-3) << modulus;
    }
  }
}

TEST(VolumeForce, HoldsUpABallThatWouldCollapse) {
  // The ball is compressed between gravity and its fixed base: the springs alone are too soft.
  const TriangleMesh mesh = make_icosphere(4);
  std::vector<std::uint32_t> foot;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.positions[v].y < -0.9) foot.push_back(v);
  }
  const auto part_left = [&](double modulus) {
    MassSpringBody body(mesh, {.vertex_mass = 0.01,
                               .stiffness = 5,
                               .damping = 0.05,
                               .air_friction = 0.05,
                               .volume_stiffness = modulus,
                               .gravity = {0, -10, 0},
                               .fixed_vertices = foot});
    const double before = body.volume();
    run(body, 4, 1600);
    return body.volume() / before;
  };
  EXPECT_LT(part_left(0), 0) << "inside out";
  EXPECT_NEAR(part_left(50), 0.893, 0.01);
  EXPECT_NEAR(part_left(200), 0.974, 0.005);
  EXPECT_NEAR(part_left(1000), 0.995, 0.002);
}

}  // namespace supple::volume_test
