#include <gtest/gtest.h>

#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/motion.hpp"

namespace supple::undo_step_test {

struct State {
  std::vector<Vec3d> positions, velocities;
  std::vector<double> rest_lengths;
  bool operator==(const State&) const = default;
};

State state_of(const MassSpringBody& body) {
  State state;
  state.positions.assign(body.positions().begin(), body.positions().end());
  state.velocities.assign(body.velocities().begin(), body.velocities().end());
  for (const MassSpringBody::Spring& spring : body.springs())
    state.rest_lengths.push_back(spring.rest_length);
  return state;
}

/// A stretched body that is released from rest.
MassSpringBody swinging(const MassSpringOptions& options) {
  const TriangleMesh mesh = make_torus(10, 6);
  MassSpringBody body(mesh, options);
  std::vector<Vec3d> stretched = mesh.positions;
  for (Vec3d& p : stretched) p.x *= 1.2;
  body.set_positions(stretched);
  return body;
}

TEST(UndoStep, GoesOnAsIfTheStepHadNotBeen) {
  for (const Integrator integrator :
       {Integrator::verlet, Integrator::symplectic_euler, Integrator::backward_euler}) {
    for (const std::uint32_t substeps : {1u, 2u, 3u}) {
      for (const double yield_strain : {0.02, 1e9}) {
        MassSpringOptions options;
        options.integrator = integrator;
        options.substeps = substeps;
        options.yield_strain = yield_strain;
        MassSpringBody body = swinging(options), undisturbed = swinging(options);
        for (int step = 0; step < 5; ++step) {
          body.step(0.01);
          undisturbed.step(0.01);
        }
        const State before = state_of(body);
        body.step(0.01);
        EXPECT_NE(state_of(body), before);
        body.undo_step();
        EXPECT_EQ(state_of(body), before);
        for (int step = 0; step < 5; ++step) {
          body.step(0.01);
          undisturbed.step(0.01);
        }
        EXPECT_EQ(state_of(body), state_of(undisturbed));
      }
    }
  }
}

TEST(UndoStep, ForgetsPositionsGivenSince) {
  MassSpringBody body = swinging({});
  const State before = state_of(body);
  body.step(0.01);
  const std::vector<Vec3d> zero(body.vertex_count());
  body.set_positions(zero);
  body.set_velocities(zero);
  body.undo_step();
  EXPECT_EQ(state_of(body), before);
}

TEST(UndoStep, RefusesWhenThereIsNoStep) {
  MassSpringBody body = swinging({});
  EXPECT_THROW(body.undo_step(), Error);
  body.step(0.01);
  body.undo_step();
  EXPECT_THROW(body.undo_step(), Error);
  body.step(0.01);
  EXPECT_THROW(body.step(1e9), Error);
  EXPECT_THROW(body.undo_step(), Error);
}

}  // namespace supple::undo_step_test
