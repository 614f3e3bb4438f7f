#include "table1/table1_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <mutex>
#include <sstream>
#include <utility>

#include "commands/build_simulation.hpp"
#include "inputs/placement.hpp"
#include "program_2007/replay.hpp"
#include "results.hpp"
#include "session/settings.hpp"
#include "table1/table1_scenes.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// The options with which a variant sees an input.
SimulationOptions options_of(const Variant& variant, const cli::Input& input) {
  SimulationOptions options = input.simulation;
  options.scene = variant.method.scene;
  options.scene.bounding_volume = variant.volume;
  options.scene.threads = 1;
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
  Follower(const Variant& variant, const cli::Input& input, const Simulation& simulation, bool exact)
      : options_(options_of(variant, input)) {
    options_.scene.contacts = ContactKinds::none;
    timed_ = std::make_unique<Scene>(options_.scene);
    options_.scene.contacts = ContactKinds::intersection;
    if (exact) exact_ = std::make_unique<Scene>(options_.scene);
    for (std::size_t i = 0; i < input.objects.size(); ++i) {
      TriangleMesh mesh = input.objects[i].mesh;
      const auto start = simulation.positions(simulation.scene().objects()[i]);
      mesh.positions.assign(start.begin(), start.end());
      ObjectOptions object = input.objects[i].options;
      object.octree = variant.method.octree;
      ids_.push_back(timed_->add(mesh, object));
      if (exact_) exact_->add(mesh, object);  // with the same id
    }
  }

  void detect(const Simulation& simulation, RunCounts& counts) {
    const auto& objects = simulation.scene().objects();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      std::optional<std::array<Vec3d, 2>> bounds;
      const auto positions = simulation.positions(objects[i]);
      if (options_.fused_refit && simulation.body(objects[i]) != nullptr)
        counts.bounds_seconds += seconds_of([&] { bounds = bounds_of(positions); });
      timed_->set_positions(ids_[i], positions, bounds);
      if (exact_) exact_->set_positions(ids_[i], positions, bounds);
    }
    const TimedDetection detection(*timed_);
    counts.detection_seconds += detection.total;
    counts.broad += detection.result->volume_events.begin.size();
    counts.narrow += detection.result->narrow_phase_events.begin.size();
    if (exact_) counts.exact += exact_->detect().contact_events.begin.size();
  }

 private:
  SimulationOptions options_;
  std::unique_ptr<Scene> timed_, exact_;
  std::vector<ObjectId> ids_;
};

/// The first six say which run a row is.
const std::vector<std::string> run_columns{
    "setting",        "scene",       "edge",           "volume", "seed",           "objects",
    "broad",          "narrow",      "exact",          "steps",  "bounds_seconds", "detection_seconds",
    "motion_seconds", "mean_strain", "largest_strain", "failure"};

/// Adds a sample of the bodies: the mean over samples, bodies and edges, and the largest strain of an edge.
void sample_strain(const Simulation& simulation, double& samples, double& mean, double& largest) {
  for (const ObjectId id : simulation.scene().objects()) {
    if (simulation.body(id) == nullptr) continue;
    const EdgeStrain strain = simulation.body(id)->edge_strain();
    mean += (strain.mean - mean) / ++samples;
    largest = std::max(largest, strain.largest);
  }
}

/// Steps of the motion in `seconds` of simulated time.
std::uint64_t steps_in(double seconds, const cli::Input& input) {
  return static_cast<std::uint64_t>(std::llround(seconds / input.simulation.time_step));
}

}  // namespace

Simulation build_variant(cli::Input& input, const Variant& variant) {
  input.simulation = options_of(variant, input);
  for (cli::InputObject& object : input.objects) object.options.octree = variant.method.octree;
  return cli::build_simulation(input);
}

std::vector<RunCounts> run_scene(const Motion& motion, std::uint64_t seed, bool exact,
                                 const std::function<bool(const RunCounts&)>& go_on) {
  cli::Input input = read_scene(motion.scene, motion.variants.front().method.integrator, seed);
  if (motion.change) motion.change(input);
  // It only moves; what it detects in addition is not counted.
  cli::Input moving = input;
  moving.simulation.scene = {.contacts = ContactKinds::none, .threads = 1};
  Simulation simulation = cli::build_simulation(moving);
  std::vector<Follower> followers;
  for (const Variant& variant : motion.variants) followers.emplace_back(variant, input, simulation, exact);

  std::vector<RunCounts> counts(followers.size());
  std::vector<bool> runs(followers.size(), true);
  const auto count_all = [&] {
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const std::size_t i = simulation.step_count() % 2 == 0 ? k : counts.size() - 1 - k;
      if (runs[i]) followers[i].detect(simulation, counts[i]);
    }
  };
  count_all();
  double strain_samples = 0, mean_strain = 0, largest_strain = 0;
  try {
    for (;;) {
      for (std::size_t i = 0; i < counts.size(); ++i) runs[i] = runs[i] && go_on(counts[i]);
      if (std::find(runs.begin(), runs.end(), true) == runs.end()) break;
      double step = seconds_of([&] { simulation.step(); });
      const double detection = simulation.scene().result().stats.total_seconds;
      step *= simulation.motion_seconds() / (simulation.motion_seconds() + detection);
      if (simulation.step_count() % strain_every == 0)
        sample_strain(simulation, strain_samples, mean_strain, largest_strain);
      for (std::size_t i = 0; i < counts.size(); ++i) {
        if (!runs[i]) continue;
        ++counts[i].steps;
        counts[i].motion_seconds += step;
        counts[i].mean_strain = mean_strain;
        counts[i].largest_strain = largest_strain;
      }
      count_all();
    }
  } catch (const MotionError& error) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (runs[i]) counts[i].failure = error.what();
    }
  }
  return counts;
}

RunLog::RunLog(const std::filesystem::path& folder, const std::string& name, std::uint64_t scenes,
               bool resume) {
  make_folder(folder);
  const std::filesystem::path path = folder / (name + ".csv");
  const std::string head =
      csv_head() + fmt::format("# scenes: {:016x}\n", scenes) + csv_of(Table{name, run_columns});
  const bool goes_on = resume && std::filesystem::exists(path);
  text_ = goes_on ? cli::read_text(path) : head;
  // A program that was killed leaves an incomplete line behind.
  text_.resize(text_.rfind('\n') + 1);
  std::istringstream lines(text_), expected(head);
  std::string line, ours;
  while (std::getline(expected, ours)) {
    std::getline(lines, line);
    if (line != ours && !ours.starts_with("# date: "))
      throw Error(
          fmt::format("--resume: {} has '{}', and this program writes '{}'; give the same command and scenes "
                      "to the same program on the same machine, or leave out --resume to start again",
                      path.string(), line, ours));
  }
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    if (std::count(line.begin(), line.end(), ',') + 1 < std::ssize(run_columns))
      throw Error(fmt::format("{}: row {} is not a run; remove it, or leave out --resume to start again",
                              path.string(), number));
  }
  if (goes_on)
    std::filesystem::resize_file(path, text_.size());
  else
    write_file(path, text_);
  file_.emplace(path.string(), cli::OutputFile::Mode::append);
}

bool RunLog::has(const std::vector<Cell>& key) const {
  std::string start = '\n' + csv_of(key);
  start.back() = ',';
  return text_.find(start) != std::string::npos;
}

void RunLog::add(std::vector<Cell> row, const RunCounts& run) {
  row.insert(row.end(),
             {run.broad, run.narrow, run.exact, run.steps, run.bounds_seconds, run.detection_seconds,
              run.motion_seconds, run.mean_strain, run.largest_strain, run.failure});
  const std::string line = csv_of(row);
  std::fwrite(line.data(), 1, line.size(), file_->stream());
  std::fflush(file_->stream());
  file_->check();
}

bool run_all(const std::vector<Motion>& motions, const RunOptions& options,
             const cli::Interruption& interruption, bool show_progress) {
  constexpr double ticks = 64;  // of progress in a second of a run
  struct Task {
    Motion motion;  ///< with the variants that the log has not
    std::uint64_t seed, steps;
    std::vector<std::vector<Cell>> keys{};
  };
  std::vector<cli::Input> inputs;
  std::uint64_t hash = 0;
  for (const Motion& motion : motions) {
    inputs.push_back(read_scene(motion.scene, motion.variants.front().method.integrator, options.seed));
    for (const unsigned char c : inputs.back().scene_text) hash = cli::scrambled(hash ^ c);
  }
  RunLog log(options.folder, options.name, hash, options.resume);
  std::vector<Task> tasks;
  double total = 0;
  // In the order of the table, so that an interrupted experiment has complete rows.
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const Motion& motion = motions[m];
    const cli::Input& input = inputs[m];
    const std::optional<double> edge = edge_of(input);
    for (std::uint32_t run = 0; run < options.runs; ++run) {
      Task task{motion, options.seed + run, steps_in(motion.seconds, input)};
      std::erase_if(task.motion.variants, [&](const Variant& variant) {
        std::vector<Cell> key{variant.setting,
                              motion.scene.name,
                              edge ? Cell(*edge) : Cell(),
                              std::string(word_of(variant.volume)),
                              task.seed,
                              std::uint64_t{input.objects.size()}};
        if (log.has(key)) return true;
        task.keys.push_back(std::move(key));
        return false;
      });
      if (task.keys.empty()) continue;
      total += motion.seconds * ticks;
      tasks.push_back(std::move(task));
    }
  }
  Work work(static_cast<std::uint64_t>(total), show_progress);
  const bool by_program = options.clock == RunClock::program;
  std::mutex mutex;
  in_parallel(tasks.size(), by_program ? 1 : options.threads, [&](std::size_t index) {
    const Task& task = tasks[index];
    const double seconds = task.motion.seconds;
    std::uint64_t shown = 0;
    const auto counts = run_scene(task.motion, task.seed, options.exact, [&](const RunCounts& so_far) {
      const double by_clock = so_far.detection_seconds + so_far.motion_seconds;
      const double done = by_program ? std::min(by_clock / seconds, 1.0)
                                     : static_cast<double>(so_far.steps) / static_cast<double>(task.steps);
      if (const auto reached = static_cast<std::uint64_t>(done * seconds * ticks); reached > shown + 32) {
        const std::lock_guard lock(mutex);
        work.done(reached - std::exchange(shown, reached),
                  fmt::format("run {} of {}: {}", index + 1, tasks.size(), task.motion.scene.name));
      }
      return (by_program ? by_clock < seconds : so_far.steps < task.steps) && interruption.signal() == 0;
    });
    if (interruption.signal() != 0) return false;
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < counts.size(); ++i) log.add(task.keys[i], counts[i]);
    return true;
  });
  return interruption.signal() == 0;
}

}  // namespace supple::experiments
