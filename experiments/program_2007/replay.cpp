#include "program_2007/replay.hpp"

#include <algorithm>
#include <limits>

#include "commands/build_simulation.hpp"
#include "supple/inspection.hpp"
#include "table1/table1_scenes.hpp"
#include "work.hpp"

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

Program program_of_2007(const std::optional<Border>& border) {
  Program program{"the program of 2007", with_method_of_2007({}), octree_of_2007()};
  program.scene.contacts = ContactKinds::none;
  program.scene.threads = 1;
  if (border) program.scene.scene_octree.root = cube_around((*border)[0], (*border)[1]);
  return program;
}

ReplayedScene::ReplayedScene(const Replay& replay, const Program& program)
    : replay_(replay), program_(program), scene_(program.scene) {
  for (const TriangleMesh& mesh : replay.objects)
    ids_.push_back(scene_.add(mesh, {.octree = program.octree}));
}

ReplaySums ReplayedScene::run() {
  ReplaySums sums;
  for (const Replay::Frame& frame : replay_.frames) {
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      std::optional<std::array<Vec3d, 2>> box;
      // The loop of the motion makes the boxes in 2007; here it runs alone, so that it is timed.
      if (program_.has_bounds) sums.bounds += seconds_of([&] { box = bounds_of(frame.positions[i]); });
      scene_.set_positions(ids_[i], frame.positions[i], box);
    }
    const TimedDetection detection(scene_);
    sums.refit += detection.refit;
    sums.broad += detection.broad;
    sums.narrow += detection.narrow;
    sums.exact += detection.exact;
    sums.total += detection.total;
    sums.tests += detection.result->stats.object_pairs_tested + detection.result->stats.boxes_tested;
    sums.triangles_refitted += detection.result->stats.triangles_refitted;
    sums.candidates += detection.result->stats.candidate_pairs;
  }
  sums.total += sums.bounds;
  return sums;
}

std::uint64_t ReplayedScene::octree_bytes() const {
  const SceneInspector inspector(scene_);
  std::uint64_t bytes = 0;
  for (const ObjectId id : ids_) bytes += inspector.octree_statistics(id).bytes;
  return bytes;
}

}  // namespace supple::experiments
