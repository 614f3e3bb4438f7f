// Tests fixed vertices, rest lengths, limits of the strain and plastic deformation.

#include <gtest/gtest.h>

#include "supple/error.hpp"
#include "support/bodies.hpp"

namespace supple::shape_test {

/// The largest and the smallest strain of an edge.
struct Strains {
  double largest = -1, smallest = 1e300;
};

Strains strains_of(const MassSpringBody& body) {
  Strains strains;
  for (const auto& spring : body.springs()) {
    const double strain =
        norm(body.positions()[spring.b] - body.positions()[spring.a]) / spring.rest_length - 1;
    strains.largest = std::max(strains.largest, strain);
    strains.smallest = std::min(strains.smallest, strain);
  }
  return strains;
}

TEST(FixedVertices, StayOrMoveAlongUniformly) {
  const TriangleMesh cloth = make_cloth(6, 6);
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(cloth, {.integrator = integrator, .gravity = {0, -10, 0}, .fixed_vertices = {0, 6}});
    std::vector<Vec3d> velocities(cloth.positions.size());
    velocities[6] = {0.5, 0.25, 0};
    body.set_velocities(velocities);
    body.add_drift({0, 0, 1});
    run(body, 1, 64);
    EXPECT_EQ(body.positions()[0], cloth.positions[0]);
    EXPECT_EQ(body.positions()[6], cloth.positions[6] + velocities[6]);
    EXPECT_EQ(body.velocities()[6], velocities[6]);
    EXPECT_LT(body.positions()[45].y, -0.1) << "the other vertices fall";
  }
}

TEST(FixedVertices, CountForNoMomentum) {
  MassSpringBody body(one_spring(1), {.vertex_mass = 3, .stiffness = 0, .damping = 0, .fixed_vertices = {0}});
  body.set_velocities(std::vector<Vec3d>{{5, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(body.momentum(), (Vec3d{0, 3, 0}));
  EXPECT_EQ(body.angular_momentum(), (Vec3d{0, 0, 1.5}));
  EXPECT_EQ(body.mean_velocity(), (Vec3d{0, 1, 0}));
  EXPECT_EQ(body.energy().kinetic, 1.5);
  EXPECT_EQ(body.center_of_mass(), (Vec3d{0, 0, 0}));
}

double distance_of_ends(const MassSpringBody& body) {
  return norm(body.positions()[1] - body.positions()[0]);
}

TEST(RestLength, IsTheLengthToWhichASpringReturns) {
  for (const Integrator integrator : all_integrators) {
    for (const double factor : {0.5, 1.0, 1.75}) {
      MassSpringBody body(one_spring(2), {.integrator = integrator, .rest_length = factor, .damping = 5});
      EXPECT_EQ(body.springs()[0].rest_length, 2 * factor);
      EXPECT_NEAR(body.energy().elastic, 0.5 * 50 * (2 - 2 * factor) * (2 - 2 * factor), 1e-12);
      run(body, 20, 2000);
      EXPECT_NEAR(distance_of_ends(body), 2 * factor, 1e-9);
      EXPECT_NEAR(norm(body.center_of_mass()), 0, 1e-12);
    }
  }
}

TEST(RestLength, GivesTheOscillationOfTwoMasses) {
  // Two masses m at distance d on a spring s: d - s oscillates with the frequency √(2 k / m).
  for (const Integrator integrator : {Integrator::verlet, Integrator::symplectic_euler}) {
    MassSpringBody body(
        one_spring(1),
        {.integrator = integrator, .vertex_mass = 0.5, .stiffness = 9, .rest_length = 0.5, .damping = 0});
    for (int step = 1; step <= 2000; ++step) {
      body.step(0.0005);
      const double expected = 0.5 + 0.5 * std::cos(6 * 0.0005 * step);
      ASSERT_NEAR(distance_of_ends(body), expected, integrator == Integrator::verlet ? 2e-6 : 2e-3) << step;
    }
  }
}

TEST(RestLength, ShrinksABodyWithItsAreas) {
  const TriangleMesh mesh = make_icosphere(3);
  const double area = MassSpringBody(mesh).area();
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(mesh, {.integrator = integrator,
                               .rest_length = 0.5,
                               .damping = 2,
                               .bending_stiffness = 20,
                               .area_stiffness = 50});
    EXPECT_GT(body.energy().area, 1);
    run(body, 20, 2000);
    EXPECT_NEAR(body.area(), area / 4, 1e-5 * area);
    EXPECT_NEAR(body.energy().total(), 0, 1e-6) << "springs and areas agree about the shape at rest";
    for (const MassSpringBody::Spring& spring : body.springs()) {
      const double in_mesh = norm(mesh.positions[spring.b] - mesh.positions[spring.a]);
      ASSERT_NEAR(norm(body.positions()[spring.b] - body.positions()[spring.a]), 0.5 * in_mesh, 1e-5);
    }
    EXPECT_NEAR(body.area_error().mean, 0.75, 1e-5) << "the error is relative to the mesh";
  }
}

TEST(RestLength, IsTheLengthThatLimitsAndYieldsReferTo) {
  const TriangleMesh mesh = make_icosphere(3);
  MassSpringBody limited(mesh, {.rest_length = 0.5, .damping = 2, .max_strain = 0.1});
  run(limited, 4, 400);
  for (const MassSpringBody::Spring& spring : limited.springs()) {
    const double in_mesh = norm(mesh.positions[spring.b] - mesh.positions[spring.a]);
    const double length = norm(limited.positions()[spring.b] - limited.positions()[spring.a]);
    ASSERT_NEAR(length, 0.5 * in_mesh, 0.5 * (0.1 + 1e-3) * in_mesh);
  }
  // A spring that is held at its length in the mesh has twice its rest length. It flows until its strain is
  // the yield strain.
  MassSpringBody held(one_spring(1), {.rest_length = 0.5, .yield_strain = 0.25, .fixed_vertices = {0, 1}});
  run(held, 10, 1000);
  EXPECT_NEAR(held.springs()[0].rest_length, 1 / 1.25, 1e-6);
}

TEST(MaxStrain, HoldsAHangingSheetTogether) {
  const TriangleMesh cloth = make_cloth(10, 10);
  const auto hang = [&](double max_strain) {
    MassSpringBody body(cloth, {.vertex_mass = 0.05,
                                .stiffness = 10,
                                .air_friction = 0.05,
                                .gravity = {0, -10, 0},
                                .max_strain = max_strain,
                                .fixed_vertices = {0, 10}});
    Strains worst;
    for (int i = 0; i < 150; ++i) {
      body.step(0.01);
      const Strains now = strains_of(body);
      worst = {std::max(worst.largest, now.largest), std::min(worst.smallest, now.smallest)};
    }
    return worst;
  };
  EXPECT_GT(hang(std::numeric_limits<double>::infinity()).largest, 1);
  const Strains limited = hang(0.1);
  EXPECT_LT(limited.largest, 0.15) << "the iterations may leave some strain above the limit";
  EXPECT_GT(limited.smallest, -0.15);
  EXPECT_GT(limited.largest, 0.09);
}

TEST(MaxStrain, IsMetToItsToleranceByAFreeBody) {
  const TriangleMesh mesh = make_icosphere(3);
  MassSpringBody body(mesh, {.stiffness = 1, .max_strain = 0.05});
  body.set_velocities(random_vectors(mesh.positions.size(), 3, 12));
  for (int i = 0; i < 200; ++i) {
    body.step(0.005);
    const Strains strains = strains_of(body);
    EXPECT_LE(strains.largest, 0.05 + 2e-4);
    EXPECT_GE(strains.smallest, -0.05 - 2e-4);
  }
}

TEST(MaxStrain, LeavesEdgesBetweenFixedEndsAndEdgesWithoutLength) {
  TriangleMesh mesh = chain(4, 1);
  mesh.positions[3] = mesh.positions[2];
  MassSpringBody body(mesh, {.max_strain = 0.1, .fixed_vertices = {0, 1}});
  std::vector<Vec3d> positions = mesh.positions;
  positions[0].y = 3;
  body.set_positions(positions);
  run(body, 1, 100);
  EXPECT_EQ(body.positions()[0].y, 3);
  EXPECT_EQ(body.positions()[1].y, -1);
}

double length_at_rest_after_stretch(double stretch, const MassSpringOptions& options) {
  MassSpringBody body(one_spring(1), options);
  body.set_positions(one_spring(1 + stretch).positions);
  run(body, 20, 2000);
  EXPECT_LT(body.energy().kinetic, 1e-9);
  EXPECT_NEAR(norm(body.positions()[1] - body.positions()[0]), body.springs()[0].rest_length, 1e-5);
  return body.springs()[0].rest_length;
}

TEST(PlasticFlow, ShapeComesBackOnlyWithinYield) {
  for (const Integrator integrator : all_integrators) {
    const MassSpringOptions options{.integrator = integrator, .damping = 2, .yield_strain = 0.2};
    EXPECT_EQ(length_at_rest_after_stretch(0.19, options), 1);
    EXPECT_GT(length_at_rest_after_stretch(0.5, options), 1.01);
    EXPECT_EQ(length_at_rest_after_stretch(-0.19, options), 1);
    EXPECT_LT(length_at_rest_after_stretch(-0.5, options), 0.99);
  }
}

TEST(PlasticFlow, OfAHeldSpringGoesToItsYieldAtItsRate) {
  for (const double step : {0.001, 0.1, 100.0}) {
    MassSpringBody body(one_spring(1), {.yield_strain = 0.25, .plastic_rate = 2, .fixed_vertices = {0, 1}});
    body.set_positions(one_spring(1.5).positions);
    // The final rest length is 1.5 / 1.25.
    const int steps = std::max(1, static_cast<int>(std::lround(0.5 / step)));
    for (int i = 0; i < steps; ++i) body.step(step);
    const double expected = step > 1 ? 1.2 : 1.2 - 0.2 * std::exp(-1.0);
    EXPECT_NEAR(body.springs()[0].rest_length, expected, step > 1 ? 1e-2 : 0.2 * step);
    EXPECT_LE(body.springs()[0].rest_length, 1.2);
  }
}

TEST(PlasticFlow, TakesAreasAlong) {
  const TriangleMesh cloth = make_cloth(6, 6);
  const auto area_after_pull = [&](double yield_strain) {
    // The damping is so large that the body does not swing back beyond its yield strain.
    MassSpringBody body(cloth, {.integrator = Integrator::backward_euler,
                                .vertex_mass = 0.1,
                                .damping = 20,
                                .area_stiffness = 50,
                                .yield_strain = yield_strain});
    std::vector<Vec3d> positions = cloth.positions;
    for (Vec3d& p : positions) p = p * 1.5;
    body.set_positions(positions);
    run(body, 10, 60);
    return body.area();
  };
  EXPECT_NEAR(area_after_pull(std::numeric_limits<double>::infinity()), 1, 1e-3);
  EXPECT_GT(area_after_pull(0.1), 1.1);
}

}  // namespace supple::shape_test
