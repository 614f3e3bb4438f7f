// Motion has the same bits for any number of threads and on every machine.

#include <gtest/gtest.h>

#include <bit>

#include "core/parallel.hpp"
#include "motion/mass_spring.hpp"
#include "unit/motion/bodies.hpp"

namespace supple {
namespace {

std::uint64_t hash_of(const MassSpringBody& body, std::uint64_t hash) {
  const auto add = [&](double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> (8 * byte) & 0xff)) * 0x100000001b3u;
  };
  for (const auto vectors : {body.positions(), body.velocities()}) {
    for (const Vec3d& v : vectors) {
      for (int axis = 0; axis < 3; ++axis) add(v[axis]);
    }
  }
  add(body.energy().total());
  return hash;
}

std::uint64_t hash_of_run(const TriangleMesh& mesh, const MassSpringOptions& options, int steps) {
  MassSpringBody body(mesh, options);
  body.set_positions(deformed(mesh, 0.15, 0.0002, 21));
  body.add_drift({0.5, 0, 0});
  for (int i = 0; i < steps; ++i) body.step(0.01);
  return hash_of(body, 0xcbf29ce484222325u);
}

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

// This hash changes only with the arithmetic of a step; record the change in the changelog.
constexpr std::uint64_t golden_hash = 10756507334953599675u;

TEST(MotionGoldenHash, IsTheSameEverywhere) {
  const TriangleMesh mesh = make_torus(24, 12);
  std::uint64_t hash = 0;
  for (const Integrator integrator : all_integrators) {
    for (const double stiffness : {50.0, 5000.0}) {
      hash = hash * 31 + hash_of_run(mesh,
                                     {.integrator = integrator,
                                      .substeps = 2,
                                      .stiffness = stiffness,
                                      .air_friction = 0.1,
                                      .bending_stiffness = 5,
                                      .area_stiffness = 20,
                                      .gravity = {0, -1, 0},
                                      .max_strain = 0.1,
                                      .yield_strain = 0.05,
                                      .fixed_vertices = {0}},
                                     4);
    }
  }
  EXPECT_EQ(hash, golden_hash);
}

}  // namespace
}  // namespace supple
