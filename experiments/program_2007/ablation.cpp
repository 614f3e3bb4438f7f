#include "program_2007/program_2007.hpp"

#include <fmt/core.h>
#include <hwy/targets.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program_2007/replay.hpp"
#include "supple/inspection.hpp"
#include "supple/scene.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// Each program has one more choice of today than the one before.
std::vector<Program> programs(const std::optional<Border>& border) {
  Program program = program_of_2007(border);
  std::vector<Program> all{program};
  const auto next = [&](const char* change, const std::function<void(Program&)>& apply) {
    program.change = change;
    apply(program);
    all.push_back(program);
  };
  next("regions expand only for objects that dividing can separate", [](Program& p) {
    p.scene.scene_octree.expand_for_large_objects = false;
    p.scene.scene_octree.min_level = 0;
    p.scene.scene_octree.max_level = 0;
  });
  next("the broad phase is chosen in each step", [](Program& p) {
    p.scene.broad_phase = BroadPhaseMethod::automatic;
    p.scene.scene_octree = {};
  });
  next("all children of both sides at once, with vectors",
       [](Program& p) { p.scene.comparison.descent = Descent::both_sides; });
  next("all nodes are refitted bottom-up, in a loop of its own", [](Program& p) {
    p.scene.comparison.lazy_refit = false;
    p.has_bounds = false;
  });
  next("leaves of up to 64 triangles",
       [](Program& p) { p.octree.leaf_size = ObjectOctreeOptions{}.leaf_size; });
  next("octrees are balanced", [](Program& p) { p.octree = {}; });
  next("exact contacts instead of colliding vertices", [](Program& p) {
    p.scene.comparison.colliding_vertices = false;
    p.scene.contacts = ContactKinds::intersection;
  });
  next("with points and normals: the defaults", [](Program& p) { p.scene.contact_points = true; });
  return all;
}

/// All programs in turn, so that slow changes of the machine affect all of them.
void measure_programs(const Replay& replay, int rounds, Work& work, Table& table) {
  const std::vector<Program> all = programs(replay.border);
  std::vector<std::unique_ptr<ReplayedScene>> scenes;
  for (const Program& program : all) scenes.push_back(std::make_unique<ReplayedScene>(replay, program));
  const auto frames = static_cast<double>(replay.frames.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const ReplaySums sums = scenes[i]->run();
      table.add({replay.name, std::uint64_t{i}, all[i].change, static_cast<std::uint64_t>(round),
                 sums.bounds / frames, sums.refit / frames, sums.broad / frames, sums.narrow / frames,
                 sums.exact / frames, sums.total / frames, static_cast<double>(sums.tests) / frames,
                 static_cast<double>(sums.triangles_refitted) / frames, scenes[i]->octree_bytes()});
      work.done(1, fmt::format("{}, {}", replay.name, all[i].change));
    }
  }
}

/// The defaults with each instruction set of the processor, the narrowest first.
void measure_widths(const Replay& replay, int rounds, Table& table) {
  const Program defaults = programs(replay.border).back();
  std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  std::reverse(targets.begin(), targets.end());
  for (int round = 0; round < rounds; ++round) {
    for (const std::int64_t target : targets) {
      hwy::SetSupportedTargetsForTest(target);
      table.add({replay.name, std::string(hwy::TargetName(target)), static_cast<std::uint64_t>(round),
                 ReplayedScene(replay, defaults).run().total / static_cast<double>(replay.frames.size())});
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace

Results run_ablation(const Request& request) {
  std::vector<Table1Scene> scenes{mixed_scene(9), built_in_scene("nine")};
  if (!request.quick) scenes.push_back(built_in_scene("three_bikes"));
  const int frames = request.quick ? 20 : 100, rounds = request.quick ? 3 : 7;
  Table steps{"ablation",
              {"scene", "place", "change", "round", "bounds_seconds", "refit_seconds", "broad_seconds",
               "narrow_seconds", "exact_seconds", "total_seconds", "tests", "triangles_refitted", "bytes"}};
  Table widths{"ablation_widths", {"scene", "instructions", "round", "total_seconds"}};
  Work work(scenes.size() * static_cast<std::uint64_t>(rounds) * programs({}).size(), request.show_progress);
  for (const Table1Scene& scene : scenes) {
    const Replay replay = replay_of(scene, request.seed, frames, 2);
    measure_programs(replay, rounds, work, steps);
    measure_widths(replay, rounds, widths);
  }
  return {{std::move(steps), std::move(widths)}};
}

}  // namespace supple::experiments
