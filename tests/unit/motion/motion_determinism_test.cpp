// Motion has the same bits for any number of threads and on every machine.

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "core/parallel.hpp"
#include "motion/mass_spring.hpp"
#include "support/bodies.hpp"
#include "support/golden_motion.hpp"

namespace supple::motion_determinism_test {

TEST(MotionThreads, MakeNoDifference) {
  const TriangleMesh cloth = make_cloth(50, 50, 5, 5);
  MassSpringOptions options{
      .bending_stiffness = 5, .area_stiffness = 20, .max_strain = 0.12, .yield_strain = 0.05};
  for (const Integrator integrator : {Integrator::verlet, Integrator::symplectic_euler}) {
    options.integrator = integrator;
    std::vector<Vec3d> expected;
    for (const std::uint32_t threads : {1u, 2u, 3u}) {
      const Parallel parallel(threads);
      MassSpring body(cloth, options);
      body.set_positions(deformed(cloth, 0.14, 0.001, 22));
      for (int i = 0; i < 2; ++i) ASSERT_EQ(body.try_step(0.01, parallel), std::nullopt);
      std::vector<Vec3d> result(body.positions().begin(), body.positions().end());
      result.insert(result.end(), body.velocities().begin(), body.velocities().end());
      if (threads == 1) expected = result;
      EXPECT_EQ(result, expected) << threads;
    }
  }
}

TEST(MotionThreads, OfABodyMakeNoDifference) {
  // The cloth is large enough for several threads.
  const TriangleMesh cloth = make_cloth(110, 110, 11, 11);
  const std::uint64_t expected = hash_of_run(cloth, {.threads = 1}, 2);
  for (const std::uint32_t threads : {2u, 0u}) {
    EXPECT_EQ(hash_of_run(cloth, {.threads = threads}, 2), expected) << threads;
  }
}

TEST(MotionGoldenHash, IsTheSameEverywhere) {
  for (const std::uint32_t threads : {1u, 3u}) {
    for (const GoldenHash& golden : golden_motion_hashes)
      EXPECT_EQ(golden.compute(threads), golden.value) << golden.part << ", " << threads << " threads";
  }
}

}  // namespace supple::motion_determinism_test
