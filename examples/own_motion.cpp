// A motion of your own: the simulation calls your function in each step, and it writes the positions.
#include <cstdio>

#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/supple.hpp"

int main() {
  supple::SimulationOptions options;
  options.time_step = 0.05;
  supple::Simulation simulation(options);
  simulation.add(supple::make_model("rabbit"), {.is_static = true});

  // The fish swims past and wags its tail. Its path depends on time only.
  const supple::TriangleMesh fish = supple::make_model("fish");
  simulation.add(fish, {}, [rest = fish.positions](double seconds, std::span<supple::Vec3d> positions) {
    for (std::size_t i = 0; i < rest.size(); ++i) {
      positions[i] = rest[i] + supple::Vec3d{1.2 - 0.8 * seconds, 0.1, 0};
      positions[i].z += 0.3 * rest[i].x * rest[i].x * supple::sin_turns(seconds);
    }
  });

  // The ball continues from its last position: `positions` contains the step before.
  const supple::TriangleMesh ball = supple::make_icosphere(4);
  const supple::ObjectId shrinking =
      simulation.add(ball, {.name = "ball"}, [](double, std::span<supple::Vec3d> positions) {
        for (supple::Vec3d& p : positions) p = 0.95 * p;
      });

  while (simulation.time() < 2.5) {
    const supple::DetectResult& result = simulation.step();
    for (const supple::ObjectPair& pair : result.contact_events.begin)
      std::printf("%.2f s: %s touches %s\n", simulation.time(),
                  simulation.scene().options(pair.a).name.c_str(),
                  simulation.scene().options(pair.b).name.c_str());
    for (const supple::ObjectPair& pair : result.contact_events.end)
      std::printf("%.2f s: %s lets go of %s\n", simulation.time(),
                  simulation.scene().options(pair.a).name.c_str(),
                  simulation.scene().options(pair.b).name.c_str());
  }
  std::printf("a vertex of the ball is at (%.3f, %.3f, %.3f)\n", simulation.positions(shrinking)[0].x,
              simulation.positions(shrinking)[0].y, simulation.positions(shrinking)[0].z);
}
