// Degenerate meshes and options that are out of range.

#include <gtest/gtest.h>

#include <limits>

#include "supple/error.hpp"
#include "support/bodies.hpp"

namespace supple::degenerate_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

MassSpringOptions everything(Integrator integrator) {
  return {.integrator = integrator,
          .substeps = 2,
          .air_friction = 0.1,
          .bending_stiffness = 5,
          .area_stiffness = 10,
          .gravity = {0, -1, 0},
          .max_strain = 0.5,
          .yield_strain = 0.3};
}

TEST(DegenerateBodies, OfNothingDoNothing) {
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body({}, everything(integrator));
    body.step(0.1);
    body.add_drift({1, 0, 0});
    body.reflect(0);
    EXPECT_EQ(body.vertex_count(), 0u);
    EXPECT_TRUE(body.springs().empty());
    EXPECT_EQ(body.energy().total(), 0);
    EXPECT_EQ(body.area(), 0);
    EXPECT_EQ(body.area_error().largest, 0);
    EXPECT_EQ(body.momentum(), Vec3d{});
    EXPECT_EQ(body.center_of_mass(), Vec3d{});
    EXPECT_EQ(body.mean_velocity(), Vec3d{});
    EXPECT_TRUE(std::isinf(body.stable_step()));
  }
}

TEST(DegenerateBodies, VerticesOfNoTriangleFly) {
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body({"dust", {{0, 0, 0}, {1, 0, 0}}, {}}, {.integrator = integrator});
    body.set_velocities(std::vector<Vec3d>{{0, 1, 0}, {0, 0, 100}});
    run(body, 1, 4);
    EXPECT_EQ(body.positions()[0], (Vec3d{0, 1, 0}));
    EXPECT_EQ(body.positions()[1], (Vec3d{1, 0, 100}));
  }
}

TEST(DegenerateBodies, FlatAndDuplicateTrianglesRunOn) {
  TriangleMesh mesh{"flat",
                    {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 0}, {3, 0, 0}},
                    {{0, 1, 2}, {0, 1, 3}, {3, 1, 0}, {0, 0, 3}, {2, 2, 2}, {0, 4, 1}, {0, 1, 3}}};
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(mesh, everything(integrator));
    run(body, 2, 200);
    EXPECT_LT(norm(body.center_of_mass()), 10);
    EXPECT_TRUE(std::isfinite(body.energy().total()));
    EXPECT_TRUE(std::isfinite(body.area_error().largest));
  }
}

TEST(DegenerateBodies, EndsOfAnEdgeWithoutLengthPullTogether) {
  TriangleMesh mesh = one_spring(0);
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(mesh, {.integrator = integrator, .stiffness = 1, .damping = 1});
    body.step(0.1);
    EXPECT_EQ(body.positions()[0], Vec3d{});
    body.set_positions(one_spring(1).positions);
    run(body, 20, 200);
    EXPECT_LT(norm(body.positions()[1] - body.positions()[0]), 1e-3);
  }
}

TEST(DegenerateBodies, VerticesThatAreNotFiniteAtRestAreInert) {
  TriangleMesh mesh = make_icosphere(1);
  mesh.positions[4].y = nan;
  mesh.positions[9].x = -std::numeric_limits<double>::infinity();
  for (const Integrator integrator : all_integrators) {
    MassSpringBody body(mesh, everything(integrator));
    std::vector<Vec3d> velocities(mesh.positions.size(), {0, 0, 1});
    body.set_velocities(velocities);
    body.add_drift({1, 0, 0});
    body.set_external_forces(velocities);
    run(body, 1, 50);
    EXPECT_TRUE(std::isnan(body.positions()[4].y));
    EXPECT_EQ(body.positions()[4].x, mesh.positions[4].x);
    EXPECT_EQ(body.positions()[9], mesh.positions[9]);
    EXPECT_EQ(body.velocities()[4], Vec3d{});
    EXPECT_TRUE(std::isfinite(body.energy().total()));
    EXPECT_TRUE(std::isfinite(norm(body.momentum())));
    EXPECT_TRUE(std::isfinite(norm(body.center_of_mass())));
    EXPECT_TRUE(std::isfinite(body.area()));
    for (const auto& spring : body.springs()) {
      EXPECT_TRUE(spring.a != 4 && spring.b != 4 && spring.a != 9 && spring.b != 9);
    }
  }
}

TEST(DegenerateBodies, SliversAreNotStiff) {
  TriangleMesh mesh{"sliver", {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-12, 0}}, {{0, 1, 2}}};
  const MassSpringBody body(mesh, {.area_stiffness = 50});
  EXPECT_GT(body.stable_step(), 0.05);
}

TEST(DegenerateBodies, HugeOnesSayNothingButErrors) {
  TriangleMesh mesh = make_icosphere(1);
  for (Vec3d& p : mesh.positions) p = p * 1e200;
  MassSpringBody body(mesh, everything(Integrator::verlet));
  body.step(0.1);
  EXPECT_TRUE(body.springs().empty()) << "their lengths overflow";
}

TEST(MassSpringOptionsCheck, NamesWhatIsOutOfRange) {
  const TriangleMesh mesh = make_icosphere(1);
  const auto expect = [&](const MassSpringOptions& options, const char* what) {
    try {
      const MassSpringBody body(mesh, options);
      ADD_FAILURE() << what << " was taken";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  expect({.substeps = 0}, "substeps is 0");
  expect({.vertex_mass = 0}, "vertex_mass is 0");
  expect({.vertex_mass = 1e-320}, "vertex_mass");
  expect({.stiffness = -1}, "stiffness is -1");
  expect({.damping = nan}, "damping is nan");
  expect({.air_friction = -2}, "air_friction");
  expect({.bending_stiffness = -2}, "bending_stiffness");
  expect({.area_stiffness = std::numeric_limits<double>::infinity()}, "area_stiffness is inf");
  expect({.volume_stiffness = -3}, "volume_stiffness is -3");
  expect({.gravity = {0, nan, 0}}, "gravity");
  expect({.max_strain = 0}, "max_strain is 0");
  expect({.yield_strain = -0.5}, "yield_strain");
  expect({.plastic_rate = 0}, "plastic_rate");
  expect({.fixed_vertices = {3, 12}}, "a fixed vertex is 12");
  EXPECT_THROW(MassSpringBody({"bad", {{0, 0, 0}}, {{0, 0, 1}}}), Error);
}

TEST(MassSpringBody, TakesOnlyAsManyVectorsAsItHasVertices) {
  MassSpringBody body(make_icosphere(1));
  const std::vector<Vec3d> eleven(11), thirteen(13);
  EXPECT_THROW(body.set_positions(eleven), Error);
  EXPECT_THROW(body.set_velocities(thirteen), Error);
  EXPECT_THROW(body.set_external_forces(eleven), Error);
  EXPECT_THROW(body.reflect(3), Error);
  EXPECT_THROW(body.reflect(-1), Error);
}

TEST(MassSpringBody, TellsItsRestState) {
  const TriangleMesh mesh = make_box({1, 2, 3}, 3);
  const MassSpringBody body(mesh, {.area_stiffness = 5});
  EXPECT_NEAR(body.area(), 22, 1e-12);
  EXPECT_EQ(body.area_error().largest, 0);
  EXPECT_EQ(body.energy().total(), 0);
  EXPECT_EQ(largest_difference(body.positions(), mesh.positions), 0);
  MassSpringBody larger(mesh);
  std::vector<Vec3d> positions = mesh.positions;
  for (Vec3d& p : positions) p = p * 1.1;
  larger.set_positions(positions);
  EXPECT_NEAR(larger.area_error().largest, 0.21, 1e-12);
  EXPECT_NEAR(larger.area_error().mean, 0.21, 1e-12);
}

}  // namespace supple::degenerate_test
