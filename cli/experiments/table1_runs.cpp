#include "experiments/table1_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "experiments/table1_scenes.hpp"
#include "experiments/work.hpp"
#include "supple/simulation.hpp"

namespace supple::experiments {
namespace {

SimulationOptions simulation_options(const cli::Input& input, BoundingVolume volume, std::uint64_t seed,
                                     std::uint32_t threads) {
  SimulationOptions options = input.simulation;
  options.seed = seed;
  options.scene.bounding_volume = volume;
  options.scene.comparison.sphere_fit = SphereFit::vertices;
  options.scene.contact_points = false;
  options.scene.comparison.colliding_vertices = true;
  options.scene.threads = threads;
  return options;
}

Runs start_of(const std::string& scene, const cli::Input& input, BoundingVolume volume, double run_seconds) {
  Runs runs{scene, input.objects.size(), {}, volume, {}, run_seconds};
  for (const cli::InputObject& object : input.objects) {
    const std::string model = object.mesh.name.substr(0, object.mesh.name.find(' '));
    if (runs.models.find(model) == std::string::npos)
      runs.models += (runs.models.empty() ? "" : ", ") + model;
  }
  return runs;
}

std::uint64_t vertices_of(const cli::Input& input) {
  std::uint64_t vertices = 0;
  for (const cli::InputObject& object : input.objects) vertices += object.mesh.positions.size();
  return vertices;
}

/// A planned run: the index of its `Runs`, its index in them, and its numbers of steps and vertices.
struct Task {
  std::size_t runs, run;
  std::uint64_t steps, vertices;
};

/// Empty results for every scene with both kinds of volumes, and the tasks that fill them.
std::vector<Runs> plan(const Table1Options& options, std::vector<Task>& tasks) {
  std::vector<Runs> all;
  for (const std::string& scene : options.scenes) {
    const cli::Input input = table1_scene(scene);
    const auto steps =
        static_cast<std::uint64_t>(std::llround(options.simulated_seconds / input.simulation.time_step));
    for (const BoundingVolume volume : table1_volumes) {
      for (std::uint32_t run = 0; run < options.runs; ++run)
        tasks.push_back({all.size(), run, steps, vertices_of(input)});
      all.push_back(start_of(scene, input, volume, options.simulated_seconds));
      all.back().counts.resize(options.runs);
    }
  }
  // The longest runs start first, so that no thread still has a long run at the end.
  std::sort(tasks.begin(), tasks.end(),
            [](const Task& a, const Task& b) { return a.steps * a.vertices > b.steps * b.vertices; });
  return all;
}

}  // namespace

RunCounts run_scene(const std::string& scene, BoundingVolume volume, std::uint64_t seed,
                    std::uint32_t threads, const std::function<bool(std::uint64_t steps)>& go_on) {
  const cli::Input input = table1_scene(scene);
  Simulation simulation(simulation_options(input, volume, seed, threads));
  for (const cli::InputObject& object : input.objects) {
    ObjectOptions options = object.options;
    options.octree.leaf_size = 1;
    options.octree.regular = true;
    simulation.add(object.mesh, options, std::get<MassSpringMotion>(*object.motion));
  }
  RunCounts counts;
  const auto count = [&](const DetectResult& result) {
    counts.broad += result.volume_events.begin.size();
    counts.narrow += result.narrow_phase_events.begin.size();
    counts.exact += result.contact_events.begin.size();
  };
  count(simulation.detect());
  try {
    while (go_on(counts.steps)) {
      count(simulation.step());
      ++counts.steps;
    }
  } catch (const MotionError& error) {
    counts.failure = error.what();
  }
  return counts;
}

const Runs* find(const std::vector<Runs>& all, const std::string& scene, BoundingVolume volume) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Runs& r) { return r.scene == scene && r.volume == volume; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<Runs> run_by_events(const Table1Options& options, bool show_progress) {
  std::vector<Task> tasks;
  std::vector<Runs> all = plan(options, tasks);
  std::uint64_t total = 0;
  for (const Task& task : tasks) total += task.steps * task.vertices;
  Work work(total, show_progress);
  std::mutex mutex;
  std::size_t next = 0;
  std::exception_ptr fault;
  const auto run_tasks = [&] {
    for (;;) {
      std::size_t taken = 0;
      {
        const std::lock_guard lock(mutex);
        if (next == tasks.size() || fault) return;
        taken = next++;
      }
      const Task& task = tasks[taken];
      Runs& runs = all[task.runs];
      const std::string what =
          fmt::format("run {} of {}: {}, {}", taken + 1, tasks.size(), runs.scene, name_of(runs.volume));
      try {
        runs.counts[task.run] =
            run_scene(runs.scene, runs.volume, options.seed + task.run, 1, [&](std::uint64_t steps) {
              constexpr std::uint64_t often = 64;
              if (steps > 0 && steps % often == 0) {
                const std::lock_guard lock(mutex);
                work.done(often * task.vertices, what);
              }
              return steps < task.steps;
            });
      } catch (...) {
        const std::lock_guard lock(mutex);
        fault = std::current_exception();
      }
    }
  };
  const unsigned cores = std::max(std::thread::hardware_concurrency(), 1u);
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < (options.threads == 0 ? cores : options.threads); ++i)
    threads.emplace_back(run_tasks);
  run_tasks();
  for (std::thread& thread : threads) thread.join();
  if (fault) std::rethrow_exception(fault);
  return all;
}

std::vector<Runs> run_by_clock(const Table1Options& options, double run_seconds, bool show_progress) {
  Work work(options.scenes.size() * table1_volumes.size() * options.runs, show_progress);
  std::vector<Runs> all;
  for (const std::string& scene : options.scenes) {
    const cli::Input input = table1_scene(scene);
    for (const BoundingVolume volume : table1_volumes) {
      Runs& runs = all.emplace_back(start_of(scene, input, volume, run_seconds));
      for (std::uint32_t run = 0; run < options.runs; ++run) {
        const auto start = std::chrono::steady_clock::now();
        runs.counts.push_back(
            run_scene(scene, volume, options.seed + run, options.threads, [&](std::uint64_t) {
              return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() <
                     run_seconds;
            }));
        work.done(1, fmt::format("by the clock: {}, {}, run {} of {}", scene, name_of(volume), run + 1,
                                 options.runs));
      }
    }
  }
  return all;
}

}  // namespace supple::experiments
