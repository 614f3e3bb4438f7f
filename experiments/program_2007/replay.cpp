#include "program_2007/replay.hpp"

#include <algorithm>
#include <limits>

#include "commands/build_simulation.hpp"
#include "table1/table1_scenes.hpp"

namespace supple::experiments {

std::array<Vec3d, 2> bounds_of(std::span<const Vec3d> positions) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<Vec3d, 2> bounds{Vec3d{infinity, infinity, infinity}, Vec3d{-infinity, -infinity, -infinity}};
  for (const Vec3d& p : positions) {
    for (int axis = 0; axis < 3; ++axis) {
      bounds[0][axis] = std::min(bounds[0][axis], p[axis]);
      bounds[1][axis] = std::max(bounds[1][axis], p[axis]);
    }
  }
  return bounds;
}

Replay replay_of(const Table1Scene& scene, std::uint64_t seed, int frames, int steps_per_frame) {
  constexpr double latest_start = 60;
  cli::Input input = read_scene(scene, std::nullopt, seed);
  input.simulation.scene.contacts = ContactKinds::none;
  Simulation simulation = cli::build_simulation(input);
  Replay replay{scene.name, {}, input.simulation.border};
  for (const cli::InputObject& object : input.objects) replay.objects.push_back(object.mesh);
  const auto is_near = [&] { return simulation.scene().result().stats.candidate_pairs > 0; };
  while (simulation.time() < 1 || (!is_near() && simulation.time() < latest_start)) simulation.step();
  for (int frame = 0; frame < frames; ++frame) {
    for (int step = 0; step < steps_per_frame; ++step) simulation.step();
    Replay::Frame& positions = replay.frames.emplace_back();
    for (const ObjectId id : simulation.scene().objects()) {
      const auto of_object = simulation.positions(id);
      positions.positions.emplace_back(of_object.begin(), of_object.end());
      positions.bounds.push_back(bounds_of(positions.positions.back()));
    }
  }
  return replay;
}

}  // namespace supple::experiments
