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

/// A way to detect.
struct Program {
  std::string change;  ///< against the program before
  SceneOptions scene;
  ObjectOctreeOptions octree;
  bool has_bounds = true;  ///< the loop of the motion finds the bounds
};

/// Each program has one more choice of today than the one before.
std::vector<Program> programs(const std::optional<Border>& border) {
  Program program{"the program of 2007", with_method_of_2007({}), octree_of_2007()};
  program.scene.contacts = ContactKinds::none;
  program.scene.threads = 1;
  if (border) program.scene.scene_octree.root = cube_around((*border)[0], (*border)[1]);
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

/// A scene with the objects of a replay.
class Run {
 public:
  Run(const Replay& replay, const Program& program)
      : replay_(replay), program_(program), scene_(program.scene) {
    for (const TriangleMesh& mesh : replay.objects)
      ids_.push_back(scene_.add(mesh, {.octree = program.octree}));
  }

  /// One round over the frames: the means of a step, from the bounds on.
  std::vector<Cell> replay() {
    double bounds = 0, refit = 0, broad = 0, narrow = 0, exact = 0, total = 0;
    std::uint64_t tests = 0, triangles = 0, bytes = 0;
    for (const Replay::Frame& frame : replay_.frames) {
      for (std::size_t i = 0; i < ids_.size(); ++i) {
        std::optional<std::array<Vec3d, 2>> box;
        // The loop of the motion makes the boxes in 2007; here it runs alone, so that it is timed.
        if (program_.has_bounds) bounds += seconds_of([&] { box = bounds_of(frame.positions[i]); });
        scene_.set_positions(ids_[i], frame.positions[i], box);
      }
      const TimedDetection detection(scene_);
      const StepStats& stats = detection.result->stats;
      refit += detection.refit;
      broad += detection.broad;
      narrow += detection.narrow;
      exact += detection.exact;
      total += detection.total;
      tests += stats.object_pairs_tested + stats.boxes_tested;
      triangles += stats.triangles_refitted;
    }
    const SceneInspector inspector(scene_);
    for (const ObjectId id : ids_) bytes += inspector.octree_statistics(id).bytes;
    const auto frames = static_cast<double>(replay_.frames.size());
    const auto of_step = [&](auto sum) { return static_cast<double>(sum) / frames; };
    return {of_step(bounds), of_step(refit),     of_step(broad),
            of_step(narrow), of_step(exact),     of_step(bounds + total),
            of_step(tests),  of_step(triangles), bytes};
  }

 private:
  const Replay& replay_;
  const Program& program_;
  Scene scene_;
  std::vector<ObjectId> ids_;
};

void add_row(std::vector<Cell> head, const std::vector<Cell>& numbers, Table& table) {
  head.insert(head.end(), numbers.begin(), numbers.end());
  table.add(std::move(head));
}

/// All programs in turn, so that slow changes of the machine affect all of them.
void measure_programs(const Replay& replay, const std::vector<Program>& all, int rounds, Work& work,
                      Table& table) {
  std::vector<std::unique_ptr<Run>> runs;
  for (const Program& program : all) runs.push_back(std::make_unique<Run>(replay, program));
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      add_row({replay.name, std::uint64_t{i}, all[i].change, static_cast<std::uint64_t>(round)},
              runs[i]->replay(), table);
      work.done(1, fmt::format("{}, {}", replay.name, all[i].change));
    }
  }
}

/// The defaults with each instruction set of the processor, the narrowest first.
void measure_widths(const Replay& replay, int rounds, Table& table) {
  const std::vector<Program> all = programs(replay.border);
  std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  std::reverse(targets.begin(), targets.end());
  for (int round = 0; round < rounds; ++round) {
    for (const std::int64_t target : targets) {
      hwy::SetSupportedTargetsForTest(target);
      table.add({replay.name, std::string(hwy::TargetName(target)), static_cast<std::uint64_t>(round),
                 Run(replay, all.back()).replay()[5]});
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace

AblationOptions ablation_options(bool quick) {
  AblationOptions options;
  if (quick) {
    options.with_bikes = false;
    options.frames = 20;
    options.rounds = 3;
  }
  return options;
}

Results run_ablation(const AblationOptions& options, bool show_progress) {
  std::vector<Table1Scene> scenes{mixed_scene(9), {Table1Scene::Source::built_in, "nine"}};
  if (options.with_bikes) scenes.push_back({Table1Scene::Source::built_in, "three_bikes"});
  Table steps{"ablation",
              {"scene", "place", "change", "round", "bounds_seconds", "refit_seconds", "broad_seconds",
               "narrow_seconds", "exact_seconds", "total_seconds", "tests", "triangles_refitted", "bytes"}};
  Table widths{"ablation_widths", {"scene", "instructions", "round", "total_seconds"}};
  Work work(scenes.size() * static_cast<std::uint64_t>(options.rounds) * programs({}).size(), show_progress);
  for (const Table1Scene& scene : scenes) {
    const Replay replay = replay_of(scene, options.seed, options.frames, 2);
    measure_programs(replay, programs(replay.border), options.rounds, work, steps);
    measure_widths(replay, options.rounds, widths);
  }
  return {"ablation",
          {{"frames", fmt::format("{}", options.frames)}, {"seed", fmt::format("{}", options.seed)}},
          {std::move(steps), std::move(widths)}};
}

}  // namespace supple::experiments
