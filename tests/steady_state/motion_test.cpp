// After their buffers are allocated, steps of mass-spring bodies allocate no memory.

#include <gtest/gtest.h>

#include <vector>

#include "allocation_count.hpp"
#include "supple/models.hpp"
#include "supple/motion.hpp"

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

}  // namespace
}  // namespace supple
