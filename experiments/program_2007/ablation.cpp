#include "program_2007/ablation.hpp"

#include <fmt/core.h>
#include <hwy/targets.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fit.hpp"
#include "judgement.hpp"
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
std::vector<Program> programs(const std::optional<Border>& border, std::uint32_t threads) {
  Program program{"the program of 2007", with_method_of_2007({}), octree_of_2007()};
  program.scene.contacts = ContactKinds::none;
  program.scene.threads = threads;
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

/// Sums over the frames of one round, in seconds.
struct Times {
  double refit = 0, broad = 0, narrow = 0, exact = 0, total = 0;
};

struct Cost {
  std::vector<Times> rounds;
  std::uint64_t tests = 0, bytes = 0, triangles_refitted = 0;
};

/// A scene with the objects of a replay.
class Run {
 public:
  Run(const Replay& replay, const Program& program)
      : replay_(replay), program_(program), scene_(program.scene) {
    for (const TriangleMesh& mesh : replay.objects)
      ids_.push_back(scene_.add(mesh, {.octree = program.octree}));
  }

  void replay(Cost& cost) {
    const bool is_first = cost.rounds.empty();
    Times& times = cost.rounds.emplace_back();
    for (const Replay::Frame& frame : replay_.frames) {
      for (std::size_t i = 0; i < ids_.size(); ++i) {
        if (program_.has_bounds)
          scene_.set_positions(ids_[i], frame.positions[i], frame.bounds[i]);
        else
          scene_.set_positions(ids_[i], frame.positions[i]);
      }
      const StepStats& stats = scene_.detect().stats;
      times.refit += stats.refit_seconds;
      times.broad += stats.broad_phase_seconds;
      times.narrow += stats.traversal_seconds;
      times.exact += stats.exact_seconds;
      times.total += stats.total_seconds;
      if (!is_first) continue;
      cost.tests += stats.object_pairs_tested + stats.boxes_tested;
      cost.triangles_refitted += stats.triangles_refitted;
    }
    if (!is_first) return;
    const SceneInspector inspector(scene_);
    for (const ObjectId id : ids_) cost.bytes += inspector.octree_statistics(id).bytes;
  }

 private:
  const Replay& replay_;
  const Program& program_;
  Scene scene_;
  std::vector<ObjectId> ids_;
};

/// All programs in turn, so that slow changes of the machine affect all of them.
std::vector<Cost> measure(const Replay& replay, const std::vector<Program>& all, int rounds, Work& work) {
  std::vector<Cost> costs(all.size());
  std::vector<std::unique_ptr<Run>> runs;
  for (const Program& program : all) runs.push_back(std::make_unique<Run>(replay, program));
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      runs[i]->replay(costs[i]);
      work.done(1, fmt::format("{}, {}", replay.name, all[i].change));
    }
  }
  return costs;
}

template <class Number>
std::vector<double> numbers(const Cost& cost, const Number& number) {
  std::vector<double> result;
  for (const Times& times : cost.rounds) result.push_back(number(times));
  return result;
}

/// The ratio of the totals of two programs, round by round.
Estimate ratio(const Cost& cost, const Cost& other) {
  const auto total = [](const Times& times) { return times.total; };
  return ratio_of(numbers(cost, total), numbers(other, total));
}

void add_rows(const Replay& replay, const std::vector<Program>& all, const std::vector<Cost>& costs,
              Table& table) {
  const auto frames = static_cast<double>(replay.frames.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Cost& cost = costs[i];
    const auto ms = [&](double Times::*member) {
      return least(numbers(cost, [&](const Times& times) { return times.*member; })) / frames * 1e3;
    };
    const Estimate of_first = ratio(costs[0], cost), of_before = ratio(costs[i > 0 ? i - 1 : 0], cost);
    table.add({replay.name, all[i].change, ms(&Times::refit), ms(&Times::broad), ms(&Times::narrow),
               ms(&Times::exact), ms(&Times::total), of_before.mean, of_before.error, of_first.mean,
               of_first.error, static_cast<double>(cost.tests) / frames,
               static_cast<double>(cost.triangles_refitted) / frames,
               static_cast<double>(cost.bytes) / 1024});
  }
}

/// The defaults with each instruction set of the processor.
void add_widths(const Replay& replay, std::uint32_t threads, int rounds, Table& table) {
  const std::vector<Program> all = programs(replay.border, threads);
  std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  std::reverse(targets.begin(), targets.end());  // the narrowest first
  std::vector<Cost> costs(targets.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < targets.size(); ++i) {
      hwy::SetSupportedTargetsForTest(targets[i]);
      Run(replay, all.back()).replay(costs[i]);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Estimate of_first = ratio(costs[0], costs[i]);
    table.add({replay.name, std::string(hwy::TargetName(targets[i])),
               least(numbers(costs[i], [](const Times& times) { return times.total; })) /
                   static_cast<double>(replay.frames.size()) * 1e3,
               of_first.mean, of_first.error});
  }
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

Report run_ablation(const AblationOptions& options, bool show_progress) {
  std::vector<Table1Scene> scenes{mixed_scene(9), {Table1Scene::Source::built_in, "nine"}};
  if (options.with_bikes) scenes.push_back({Table1Scene::Source::built_in, "three_bikes"});
  Table steps{
      "ablation",
      "Milliseconds of a step (the fastest round), and how many times faster than the row above and than "
      "the first row (median of the rounds)",
      {{"scene", "Scene"},
       {"change", "One more choice of today"},
       {"refit_ms", "Refit ms"},
       {"broad_ms", "Broad ms"},
       {"narrow_ms", "Narrow ms"},
       {"exact_ms", "Exact ms"},
       {"total_ms", "Total ms"},
       {"times_before", "× above"},
       {"times_before_error", "± error", 2},
       {"times_first", "× 2007"},
       {"times_first_error", "± error", 2},
       {"tests", "Tests"},
       {"triangles_refitted", "Triangles refitted"},
       {"kib", "KiB of octrees"}}};
  Table widths{"ablation_widths",
               "The defaults with each instruction set",
               {{"scene", "Scene"},
                {"instructions", "Instructions"},
                {"total_ms", "Total ms"},
                {"times_first", "× first"},
                {"times_first_error", "± error", 2}}};
  std::string summary;
  Verdict all_faster = Verdict::holds;
  std::optional<Estimate> least_gain;
  Work work(scenes.size() * static_cast<std::uint64_t>(options.rounds) * programs({}, 1).size(),
            show_progress);
  for (const Table1Scene& scene : scenes) {
    const Replay replay = replay_of(scene, options.seed, options.frames, 2);
    const std::vector<Program> all = programs(replay.border, options.threads);
    const std::vector<Cost> costs = measure(replay, all, options.rounds, work);
    add_rows(replay, all, costs, steps);
    add_widths(replay, options.threads, options.rounds, widths);
    const Estimate whole = ratio(costs.front(), costs.back());
    all_faster = both(all_faster, above(whole, 1));
    if (!least_gain || whole.mean < least_gain->mean) least_gain = whole;
    summary += fmt::format("{}{} times for {}", summary.empty() ? "" : ", ", text_of(whole), replay.name);
  }
  Report report;
  report.name = "ablation";
  report.title = "From the program of 2007 to today, one choice at a time";
  report.summary = fmt::format(
      "Each row has one more choice of today than the row above, on the same frames, with {} thread{}. The "
      "program of 2007 takes this many times the time of today's defaults, which also decide all contacts "
      "exactly: {}.",
      options.threads, options.threads == 1 ? "" : "s", summary);
  report.parameters = {{"frames", fmt::format("{}", options.frames)},
                       {"rounds", fmt::format("{}", options.rounds)},
                       {"threads", fmt::format("{}", options.threads)},
                       {"seed", fmt::format("{}", options.seed)}};
  report.claims = {
      {"today-is-faster", "",
       "Today's defaults take less time than the program of 2007 in each scene, although they decide all "
       "contacts exactly.",
       all_faster, fmt::format("The program of 2007 takes this many times as long: {}.", summary), least_gain,
       "time of the program of 2007 / of today, in the scene with the least"}};
  report.sections = {
      {"One choice at a time",
       {"The first row is the method of the paper in this library, not the program of 2007 on its machine. "
        "Its "
        "output is the vertices in colliding leaves; the last two rows find contacts instead."},
       {steps}},
      {"Width of vectors", {"The kernels of the same program with narrower vectors."}, {widths}}};
  return report;
}

}  // namespace supple::experiments
