#include "table1/table1_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "base/missing_threads.hpp"
#include "commands/build_simulation.hpp"
#include "session/settings.hpp"
#include "table1/table1_scenes.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// A planned run: the index of its `Runs`, its index in them, and its numbers of steps and vertices. Runs by
/// the clock ignore the steps.
struct Task {
  std::size_t runs;
  std::uint32_t run;
  std::uint64_t steps, vertices;

  std::uint64_t work() const { return steps * vertices; }
};

/// The results of every scene with every kind of volume, filled with the complete runs, and the tasks that
/// fill the others. One run of each kind follows the other, so that slow changes of the machine affect all
/// kinds.
std::vector<Runs> plan(const Table1Options& options, double run_seconds, const RunLog& log,
                       std::vector<Task>& tasks) {
  std::vector<Runs> all;
  std::vector<Task> first_tasks;
  for (const Table1Scene& scene : options.scenes) {
    const cli::Input input = read_scene(scene, options.method.integrator, options.seed);
    std::uint64_t vertices = 0;
    for (const cli::InputObject& object : input.objects) vertices += object.mesh.positions.size();
    const auto steps =
        static_cast<std::uint64_t>(std::llround(options.simulated_seconds / input.simulation.time_step));
    for (const BoundingVolume volume : options.method.volumes) {
      first_tasks.push_back({all.size(), 0, steps, vertices});
      const bool is_first = find(all, scene.name, volume) == nullptr;
      all.push_back({scene, is_first, input.objects.size(), edge_of(input), volume, run_seconds,
                     std::vector<RunCounts>(options.runs)});
    }
  }
  for (std::uint32_t run = 0; run < options.runs; ++run) {
    for (Task task : first_tasks) {
      task.run = run;
      if (const RunCounts* const done = log.find(all[task.runs], options.seed + run))
        all[task.runs].counts[run] = *done;
      else
        tasks.push_back(task);
    }
  }
  return all;
}

std::string name_of(const Runs& runs) {
  return fmt::format("{}{}, {}", runs.scene.name,
                     runs.scene.size ? fmt::format(" in a cube of {}", *runs.scene.size) : "",
                     word_of(runs.volume));
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

}  // namespace

RunCounts run_scene(const Table1Scene& scene, const Table1Method& method, BoundingVolume volume,
                    std::uint64_t seed, std::uint32_t threads,
                    const std::function<bool(const RunCounts&)>& go_on,
                    const std::function<void(cli::Input&)>& change) {
  cli::Input input = read_scene(scene, method.integrator, seed);
  if (change) change(input);
  input.simulation.scene = method.scene;
  input.simulation.scene.bounding_volume = volume;
  input.simulation.scene.threads = threads;
  if (method.root_is_border && input.simulation.border) {
    const auto& [lowest, highest] = *input.simulation.border;
    input.simulation.scene.scene_octree.root = cube_around(lowest, highest);
  }
  // Other methods refuse options of the scene octree.
  if (!viewer::uses_scene_octree(method.scene.broad_phase)) input.simulation.scene.scene_octree = {};
  input.simulation.fused_refit = method.fused_refit && method.scene.comparison.lazy_refit;
  for (cli::InputObject& object : input.objects) object.options.octree = method.octree;
  Simulation simulation = cli::build_simulation(input);
  RunCounts counts;
  StrainSampler strain;
  const auto count = [&](const DetectResult& result) {
    counts.broad += result.volume_events.begin.size();
    counts.narrow += result.narrow_phase_events.begin.size();
    counts.exact += result.contact_events.begin.size();
    counts.detection_seconds += result.stats.total_seconds;
  };
  count(simulation.detect());
  try {
    while (go_on(counts)) {
      count(simulation.step());
      counts.motion_seconds += simulation.motion_seconds();
      if (++counts.steps % StrainSampler::every == 0) strain.add(simulation, counts.strain);
    }
  } catch (const MotionError& error) {
    counts.failure = error.what();
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
  // The longest runs start first, so that no thread still has a long run at the end.
  std::sort(tasks.begin(), tasks.end(), [](const Task& a, const Task& b) {
    return a.work() != b.work() ? a.work() > b.work() : std::pair(a.run, a.runs) < std::pair(b.run, b.runs);
  });
  std::uint64_t total = 0;
  for (const Task& task : tasks) total += task.work();
  Work work(total, show_progress);
  std::mutex mutex;
  std::size_t next = 0;
  std::exception_ptr fault;
  const auto run_task = [&](const Task& task, const std::string& what) {
    Runs& runs = all[task.runs];
    const std::uint64_t seed = options.seed + task.run;
    const RunCounts counts =
        run_scene(runs.scene, options.method, runs.volume, seed, 1, [&](const RunCounts& so_far) {
          constexpr std::uint64_t often = 64;
          if (so_far.steps > 0 && so_far.steps % often == 0) {
            const std::lock_guard lock(mutex);
            work.done(often * task.vertices, what);
          }
          return so_far.steps < task.steps && interruption.signal() == 0;
        });
    const std::lock_guard lock(mutex);
    if (interruption.signal() != 0 && counts.steps < task.steps && counts.failure.empty()) return;
    log.add(runs, seed, counts);
    runs.counts[task.run] = counts;
  };
  const auto run_tasks = [&] {
    while (interruption.signal() == 0) {
      std::size_t taken = 0;
      {
        const std::lock_guard lock(mutex);
        if (next == tasks.size() || fault) return;
        taken = next++;
      }
      try {
        run_task(tasks[taken],
                 fmt::format("run {} of {}: {}", taken + 1, tasks.size(), name_of(all[tasks[taken].runs])));
      } catch (...) {
        const std::lock_guard lock(mutex);
        fault = std::current_exception();
      }
    }
  };
  const unsigned cores = std::max(std::thread::hardware_concurrency(), 1u);
  const unsigned given = options.threads.value_or(0);
  std::vector<std::thread> threads;
  const unsigned wanted = given == 0 ? cores : given;
  try {
    while (threads.size() + 1 < wanted) threads.emplace_back(run_tasks);
  } catch (const std::system_error&) {
    cli::warn_of_missing_threads(wanted, static_cast<unsigned>(threads.size()) + 1);
  }
  run_tasks();
  for (std::thread& thread : threads) thread.join();
  if (fault) std::rethrow_exception(fault);
  if (interruption.signal() != 0) return std::nullopt;
  return all;
}

std::optional<std::vector<Runs>> run_by_clock(const Table1Options& options, RunClock clock, RunLog& log,
                                              const cli::Interruption& interruption, bool show_progress) {
  constexpr double ticks = 100;  // of progress in a second
  const bool with_motion = clock == RunClock::program;
  const double run_seconds = with_motion ? *options.program_clock : *options.wall_clock;
  Table1Method method = options.method;
  method.scene.contacts = ContactKinds::none;
  std::vector<Task> tasks;
  std::vector<Runs> all = plan(options, run_seconds, log, tasks);
  Work work(static_cast<std::uint64_t>(static_cast<double>(tasks.size()) * run_seconds * ticks),
            show_progress);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    Runs& runs = all[tasks[i].runs];
    const std::uint64_t seed = options.seed + tasks[i].run;
    const std::string what = fmt::format("run {} of {} by the clock{}: {}", i + 1, tasks.size(),
                                         with_motion ? " with motion" : "", name_of(runs));
    std::uint64_t shown = 0;
    RunCounts counts;
    const double real_seconds = seconds_of([&] {
      counts = run_scene(
          runs.scene, method, runs.volume, seed, options.threads.value_or(1), [&](const RunCounts& so_far) {
            const double seconds = so_far.detection_seconds + (with_motion ? so_far.motion_seconds : 0);
            const auto reached = static_cast<std::uint64_t>(seconds * ticks);
            if (reached > shown) work.done(reached - std::exchange(shown, reached), what);
            return seconds < run_seconds && interruption.signal() == 0;
          });
    });
    if (interruption.signal() != 0) return std::nullopt;
    counts.real_seconds = real_seconds;
    log.add(runs, seed, counts);
    runs.counts[tasks[i].run] = counts;
  }
  return all;
}

}  // namespace supple::experiments
