#include "table1/table1_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <utility>

#include "commands/build_simulation.hpp"
#include "session/settings.hpp"
#include "table1/table1_scenes.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// A planned run: its scene with the volumes that are not yet in the log, as indices of their `Runs`, its
/// index in them, and its numbers of steps and vertices. Runs by the clock ignore the steps.
struct Task {
  std::vector<std::size_t> runs{};
  std::uint32_t run = 0;
  std::uint64_t steps = 0, vertices = 0;
};

/// The results of every scene with every kind of volume, filled with the complete runs, and the tasks that
/// fill the others.
std::vector<Runs> plan(const Table1Options& options, double run_seconds, const RunLog& log,
                       std::vector<Task>& tasks) {
  std::vector<Runs> all;
  std::vector<Task> first_tasks;
  for (const Table1Scene& scene : options.scenes) {
    const cli::Input input = read_scene(scene, options.method.integrator, options.seed);
    Task& task = first_tasks.emplace_back();
    for (const cli::InputObject& object : input.objects) task.vertices += object.mesh.positions.size();
    task.steps =
        static_cast<std::uint64_t>(std::llround(options.simulated_seconds / input.simulation.time_step));
    for (const BoundingVolume volume : options.method.volumes) {
      task.runs.push_back(all.size());
      const bool is_first = find(all, scene.name, volume) == nullptr;
      all.push_back({scene, is_first, input.objects.size(), edge_of(input), volume, run_seconds,
                     std::vector<RunCounts>(options.runs)});
    }
  }
  // In the order of the table, so that an interrupted experiment has complete rows.
  for (const Task& first : first_tasks) {
    for (std::uint32_t run = 0; run < options.runs; ++run) {
      Task task = first;
      task.run = run;
      std::erase_if(task.runs, [&](std::size_t index) {
        const RunCounts* const done = log.find(all[index], options.seed + run);
        if (done != nullptr) all[index].counts[run] = *done;
        return done != nullptr;
      });
      if (!task.runs.empty()) tasks.push_back(std::move(task));
    }
  }
  return all;
}

std::vector<Variant> variants_of(const Task& task, const std::vector<Runs>& all, const Table1Method& method) {
  std::vector<Variant> variants;
  for (const std::size_t index : task.runs) variants.push_back({method, all[index].volume});
  return variants;
}

std::string name_of(const Runs& runs) {
  return runs.scene.name + (runs.scene.size ? fmt::format(" in a cube of {}", *runs.scene.size) : "");
}

/// Samples the strain of all bodies.
class StrainSampler {
 public:
  static constexpr std::uint64_t every = 25;  // steps

  void add(const Simulation& simulation, RunStrain& strain) {
    double sum = 0, bodies = 0;
    for (const ObjectId id : simulation.scene().objects()) {
      const MassSpringBody* const body = simulation.body(id);
      if (body == nullptr) continue;
      const EdgeStrain of_body = body->edge_strain();
      strain.largest = std::max(strain.largest, of_body.largest);
      sum += of_body.mean;
      ++bodies;
    }
    if (bodies == 0) return;
    ++samples_;
    const double mean = sum / bodies;
    strain.mean += (mean - strain.mean) / samples_;
    if (simulation.time() < 1) return;
    strain.least = is_first_ ? mean : std::min(strain.least, mean);
    strain.most = std::max(strain.most, mean);
    is_first_ = false;
  }

 private:
  double samples_ = 0;
  bool is_first_ = true;
};

/// The options with which a variant sees an input.
SimulationOptions options_of(const Variant& variant, const cli::Input& input, std::uint32_t threads) {
  SimulationOptions options = input.simulation;
  options.scene = variant.method.scene;
  options.scene.bounding_volume = variant.volume;
  options.scene.threads = threads;
  if (variant.method.root_is_border && options.border) {
    const auto& [lowest, highest] = *options.border;
    options.scene.scene_octree.root = cube_around(lowest, highest);
  }
  // Other methods refuse options of the scene octree.
  if (!viewer::uses_scene_octree(options.scene.broad_phase)) options.scene.scene_octree = {};
  options.fused_refit = variant.method.fused_refit && options.scene.comparison.lazy_refit;
  return options;
}

/// A variant that follows the motion of a simulation.
class Follower {
 public:
  Follower(const Variant& variant, const cli::Input& input, const Simulation& simulation,
           std::uint32_t threads)
      : options_(options_of(variant, input, threads)), scene_(options_.scene) {
    const auto& objects = simulation.scene().objects();
    for (std::size_t i = 0; i < input.objects.size(); ++i) {
      TriangleMesh mesh = input.objects[i].mesh;
      const auto start = simulation.positions(objects[i]);
      mesh.positions.assign(start.begin(), start.end());
      ObjectOptions object = input.objects[i].options;
      object.octree = variant.method.octree;
      ids_.emplace_back(scene_.add(mesh, object), objects[i]);
    }
  }

  const DetectResult& detect(const Simulation& simulation) {
    for (const auto& [own, its] : ids_) {
      const MassSpringBody* const body = options_.fused_refit ? simulation.body(its) : nullptr;
      scene_.set_positions(own, simulation.positions(its), body != nullptr ? body->bounds() : std::nullopt);
    }
    return scene_.detect();
  }

 private:
  SimulationOptions options_;
  Scene scene_;
  std::vector<std::pair<ObjectId, ObjectId>> ids_;  ///< of the own scene and of the simulation
};

void count(const DetectResult& result, RunCounts& counts) {
  counts.broad += result.volume_events.begin.size();
  counts.narrow += result.narrow_phase_events.begin.size();
  counts.exact += result.contact_events.begin.size();
  counts.detection_seconds +=
      result.stats.total_seconds - result.stats.exact_seconds - result.stats.penetration_seconds;
}

/// `collisions` found in some seconds, in ten minutes.
double in_ten_minutes(std::uint64_t collisions, double seconds) {
  return 600 * static_cast<double>(collisions) / seconds;
}

}  // namespace

double in_ten_minutes_of_detection(std::uint64_t collisions, const RunCounts& run) {
  return in_ten_minutes(collisions, run.detection_seconds);
}

double in_ten_minutes_of_program(std::uint64_t collisions, const RunCounts& run) {
  return in_ten_minutes(collisions, run.detection_seconds + run.motion_seconds);
}

Simulation build_variant(cli::Input& input, const Variant& variant, std::uint32_t threads) {
  input.simulation = options_of(variant, input, threads);
  for (cli::InputObject& object : input.objects) object.options.octree = variant.method.octree;
  return cli::build_simulation(input);
}

std::vector<RunCounts> run_scene(const Table1Scene& scene, std::span<const Variant> variants,
                                 std::uint64_t seed, std::uint32_t threads,
                                 const std::function<bool(const RunCounts&)>& go_on,
                                 const std::function<void(cli::Input&)>& change) {
  cli::Input input = read_scene(scene, variants.front().method.integrator, seed);
  if (change) change(input);
  Simulation simulation = build_variant(input, variants.front(), threads);
  std::vector<Follower> followers;
  for (const Variant& variant : variants.subspan(1))
    followers.emplace_back(variant, input, simulation, threads);

  std::vector<RunCounts> counts(variants.size());
  const auto count_all = [&](const DetectResult& of_first, const std::vector<bool>& runs) {
    if (runs.front()) count(of_first, counts.front());
    for (std::size_t i = 1; i < counts.size(); ++i) {
      if (runs[i]) count(followers[i - 1].detect(simulation), counts[i]);
    }
  };
  std::vector<bool> runs(variants.size(), true);
  count_all(simulation.detect(), runs);
  StrainSampler sampler;
  RunStrain strain;
  try {
    for (;;) {
      for (std::size_t i = 0; i < counts.size(); ++i) runs[i] = runs[i] && go_on(counts[i]);
      if (std::find(runs.begin(), runs.end(), true) == runs.end()) break;
      const DetectResult& of_first = simulation.step();
      if (simulation.step_count() % StrainSampler::every == 0) sampler.add(simulation, strain);
      for (std::size_t i = 0; i < counts.size(); ++i) {
        if (!runs[i]) continue;
        ++counts[i].steps;
        counts[i].motion_seconds += simulation.motion_seconds();
        counts[i].strain = strain;
      }
      count_all(of_first, runs);
    }
  } catch (const MotionError& error) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (runs[i]) counts[i].failure = error.what();
    }
  }
  return counts;
}

std::vector<double> Runs::numbers(std::uint64_t RunCounts::*member) const {
  std::vector<double> result;
  for (const RunCounts& run : counts) {
    if (run.failure.empty()) result.push_back(static_cast<double>(run.*member));
  }
  return result;
}

const Runs* find(const std::vector<Runs>& all, const std::string& scene, BoundingVolume volume) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Runs& r) {
    return r.scene.name == scene && r.volume == volume && r.is_first_size;
  });
  return found == all.end() ? nullptr : &*found;
}

std::optional<std::vector<Runs>> run_by_steps(const Table1Options& options, RunLog& log,
                                              const cli::Interruption& interruption, bool show_progress) {
  std::vector<Task> tasks;
  std::vector<Runs> all = plan(options, options.simulated_seconds, log, tasks);
  std::uint64_t total = 0;
  for (const Task& task : tasks) total += task.steps * task.vertices;
  Work work(total, show_progress);
  std::mutex mutex;
  in_parallel(tasks.size(), options.threads, [&](std::size_t index) {
    const Task& task = tasks[index];
    const Runs& first = all[task.runs.front()];
    const std::string what = fmt::format("run {} of {}: {}", index + 1, tasks.size(), name_of(first));
    const std::uint64_t seed = options.seed + task.run;
    std::uint64_t shown = 0;
    const std::vector<RunCounts> counts =
        run_scene(first.scene, variants_of(task, all, options.method), seed, 1, [&](const RunCounts& so_far) {
          constexpr std::uint64_t often = 64;
          if (so_far.steps == shown + often) {
            shown = so_far.steps;
            const std::lock_guard lock(mutex);
            work.done(often * task.vertices, what);
          }
          return so_far.steps < task.steps && interruption.signal() == 0;
        });
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < task.runs.size(); ++i) {
      if (interruption.signal() != 0 && counts[i].steps < task.steps && counts[i].failure.empty()) continue;
      Runs& runs = all[task.runs[i]];
      log.add(runs, seed, counts[i]);
      runs.counts[task.run] = counts[i];
    }
    return interruption.signal() == 0;
  });
  if (interruption.signal() != 0) return std::nullopt;
  return all;
}

std::optional<std::vector<Runs>> run_by_clock(const Table1Options& options, RunLog& log,
                                              const cli::Interruption& interruption, bool show_progress) {
  constexpr double ticks = 100;  // of progress in a second
  const double run_seconds = *options.program_clock;
  Table1Method method = options.method;
  method.scene.contacts = ContactKinds::none;
  std::vector<Task> tasks;
  std::vector<Runs> all = plan(options, run_seconds, log, tasks);
  Work work(static_cast<std::uint64_t>(static_cast<double>(tasks.size()) * run_seconds * ticks),
            show_progress);
  for (std::size_t index = 0; index < tasks.size(); ++index) {
    const Task& task = tasks[index];
    const Runs& first = all[task.runs.front()];
    const std::uint64_t seed = options.seed + task.run;
    const std::string what =
        fmt::format("run {} of {} by the clock: {}", index + 1, tasks.size(), name_of(first));
    std::uint64_t shown = 0;
    const std::vector<RunCounts> counts =
        run_scene(first.scene, variants_of(task, all, method), seed, options.threads.value_or(1),
                  [&](const RunCounts& so_far) {
                    const double seconds = so_far.detection_seconds + so_far.motion_seconds;
                    const auto reached = static_cast<std::uint64_t>(seconds * ticks);
                    if (reached > shown) work.done(reached - std::exchange(shown, reached), what);
                    return seconds < run_seconds && interruption.signal() == 0;
                  });
    if (interruption.signal() != 0) return std::nullopt;
    for (std::size_t i = 0; i < task.runs.size(); ++i) {
      Runs& runs = all[task.runs[i]];
      log.add(runs, seed, counts[i]);
      runs.counts[task.run] = counts[i];
    }
  }
  return all;
}

}  // namespace supple::experiments
