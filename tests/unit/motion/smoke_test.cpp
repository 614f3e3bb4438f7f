#include <gtest/gtest.h>
#include "supple/models.hpp"
#include "supple/motion.hpp"
namespace supple {
namespace {
TEST(MotionSmoke, Falls) {
  for (auto integrator : {Integrator::verlet, Integrator::symplectic_euler, Integrator::backward_euler}) {
    MassSpringBody body(make_model("rabbit"), {.integrator = integrator, .gravity = {0, -10, 0}});
    std::printf("stable %g\n", body.stable_step());
    for (int i = 0; i < 100; ++i) body.step(0.01);
    std::printf("%.17g %g %g\n", body.center_of_mass().y, body.energy().elastic, body.mean_velocity().y);
  }
}
}  // namespace
}  // namespace supple
