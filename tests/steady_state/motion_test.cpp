// After their buffers are allocated, steps of mass-spring bodies allocate no memory. What the contact
// response keeps does not grow with the number of copies of a body.

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "allocation_count.hpp"
#include "supple/models.hpp"
#include "supple/motion.hpp"
#include "supple/simulation.hpp"

namespace supple {
namespace {

TEST(SteadyStateMotion, NoAllocationsInStepsOfExplicitIntegrators) {
  const TriangleMesh mesh = make_cloth(24, 24);
  for (const Integrator integrator : {Integrator::verlet, Integrator::symplectic_euler}) {
    MassSpringBody body(mesh, {.integrator = integrator,
                               .substeps = 3,
                               .bending_stiffness = 5,
                               .area_stiffness = 20,
                               .gravity = {0, -10, 0},
                               .max_strain = 0.1,
                               .yield_strain = 0.05,
                               .fixed_vertices = {0},
                               .threads = 1});
    const double rest_length = body.springs()[0].rest_length;
    body.step(0.01);
    const std::uint64_t before = allocation_count();
    for (int i = 0; i < 20; ++i) {
      body.add_drift({0.1, 0, 0});
      body.reflect(1);
      body.step(0.01);
    }
    EXPECT_EQ(allocation_count(), before);
    EXPECT_NE(body.springs()[0].rest_length, rest_length) << "the sheet is stretched beyond its yield";
  }
}

/// The allocations that remain from steps in which balls fall onto the floor, each onto the same vertices.
std::int64_t allocations_kept_by_falling_balls(int count) {
  SimulationOptions options{.response = ContactResponse{.thickness = 0.01}};
  options.scene.threads = 1;
  Simulation simulation(options);
  const auto placed = [](TriangleMesh mesh, Vec3d at) {
    for (Vec3d& p : mesh.positions) p = p + at;
    return mesh;
  };
  MassSpringMotion motion{.springs = {.stiffness = 200, .damping = 0.1}};
  motion.velocity = {0, -2, 0};
  for (int i = 0; i < count; ++i) {
    const Vec3d at{4.0 * i, 0, 0};
    simulation.add(placed(make_box({3, 0.2, 3}, 1), at), {.is_static = true});
    simulation.add(placed(make_icosphere(3), at + Vec3d{0, 1.2, 0}), {}, motion);
  }
  const std::int64_t before = live_allocation_count();
  for (int step = 0; step < 100; ++step) simulation.step();
  return live_allocation_count() - before;
}

TEST(SteadyStateMotion, CopiesOfABodyKeepTheSpreadOfImpulsesOnce) {
  const std::int64_t of_one = allocations_kept_by_falling_balls(1);
  EXPECT_GT(of_one, 20) << "the ball touches nothing";
  EXPECT_LT(allocations_kept_by_falling_balls(6), 2 * of_one);
}

}  // namespace
}  // namespace supple
