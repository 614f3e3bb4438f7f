// A cloth of masses and springs falls onto a ball, does not pass through it, and comes to rest there.
#include <cstdio>

#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/supple.hpp"

int main() {
  supple::SimulationOptions options;
  options.time_step = 0.005;
  options.response = supple::ContactResponse{.thickness = 0.01, .friction = 0.3};
  supple::Simulation simulation(options);

  supple::TriangleMesh ball = supple::make_icosphere(5);
  for (supple::Vec3d& p : ball.positions) p = 0.3 * p;
  simulation.add(ball, {.name = "ball", .is_static = true});

  supple::TriangleMesh cloth = supple::make_cloth(12, 12);
  for (supple::Vec3d& p : cloth.positions) p.y += 0.35;
  supple::MassSpringMotion motion;
  motion.springs.vertex_mass = 0.005;
  motion.springs.stiffness = 30;
  motion.springs.damping = 0.02;
  motion.springs.air_friction = 0.004;
  motion.springs.gravity = {0, -9.81, 0};
  const supple::ObjectId id = simulation.add(cloth, {.name = "cloth", .self_collision = true}, motion);

  for (int step = 1; step <= 300; ++step) {
    std::size_t intersecting = 0;
    try {
      intersecting = simulation.step().contacts.size();
    } catch (const supple::MotionError& error) {
      // The springs are too stiff for the step. The message names a stable step, and the state is unchanged.
      std::fprintf(stderr, "%s\n", error.what());
      return 1;
    }
    if (step % 50 != 0) continue;
    const supple::MassSpringBody& body = *simulation.body(id);
    std::printf("%.2f s: centre of mass at %.3f m, %.4f J of motion, %zu pairs of triangles intersect\n",
                simulation.time(), body.center_of_mass().y, body.energy().kinetic, intersecting);
  }
}
