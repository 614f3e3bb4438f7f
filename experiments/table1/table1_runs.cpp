#include "table1/table1_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>

#include "commands/build_simulation.hpp"
#include "machine.hpp"
#include "program_2007/replay.hpp"
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

/// The objects of a simulation in a scene of their own.
struct FollowingScene {
  Scene scene;
  std::vector<ObjectId> ids{};

  FollowingScene(const SceneOptions& options, const ObjectOctreeOptions& octree, const cli::Input& input,
                 const Simulation& simulation)
      : scene(options) {
    for (std::size_t i = 0; i < input.objects.size(); ++i) {
      TriangleMesh mesh = input.objects[i].mesh;
      const auto start = simulation.positions(simulation.scene().objects()[i]);
      mesh.positions.assign(start.begin(), start.end());
      ObjectOptions object = input.objects[i].options;
      object.octree = octree;
      ids.push_back(scene.add(mesh, object));
    }
  }
};

/// A variant that follows the motion of a simulation.
class Follower {
 public:
  Follower(const Variant& variant, const cli::Input& input, const Simulation& simulation, bool exact)
      : options_(options_of(variant, input)) {
    SceneOptions options = options_.scene;
    options.contacts = ContactKinds::none;
    timed_ = std::make_unique<FollowingScene>(options, variant.method.octree, input, simulation);
    if (!exact) return;
    options.contacts = ContactKinds::intersection;
    exact_ = std::make_unique<FollowingScene>(options, variant.method.octree, input, simulation);
  }

  void detect(const Simulation& simulation, RunCounts& counts) {
    const auto& objects = simulation.scene().objects();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      std::optional<std::array<Vec3d, 2>> bounds;
      const auto positions = simulation.positions(objects[i]);
      if (options_.fused_refit && simulation.body(objects[i]) != nullptr)
        counts.bounds_seconds += seconds_of([&] { bounds = bounds_of(positions); });
      timed_->scene.set_positions(timed_->ids[i], positions, bounds);
      if (exact_) exact_->scene.set_positions(exact_->ids[i], positions, bounds);
    }
    const TimedDetection detection(timed_->scene);
    counts.detection_seconds += detection.total;
    counts.broad += detection.result->volume_events.begin.size();
    counts.narrow += detection.result->narrow_phase_events.begin.size();
    if (exact_) counts.exact += exact_->scene.detect().contact_events.begin.size();
  }

 private:
  SimulationOptions options_;
  std::unique_ptr<FollowingScene> timed_, exact_;
};

/// The run_columns that say which run a row is, and all run_columns.
constexpr std::size_t key_columns = 6;
const std::vector<std::string> run_columns{
    "setting",        "scene",       "edge",         "volume",      "seed",           "objects",
    "broad",          "narrow",      "exact",        "steps",       "bounds_seconds", "detection_seconds",
    "motion_seconds", "mean_strain", "least_strain", "most_strain", "largest_strain", "failure"};

/// Steps of the motion in `seconds` of simulated time.
std::uint64_t steps_in(double seconds, const cli::Input& input) {
  return static_cast<std::uint64_t>(std::llround(seconds / input.simulation.time_step));
}

}  // namespace

void StrainSampler::add(const Simulation& simulation, RunStrain& strain) {
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
  StrainSampler sampler;
  RunStrain strain;
  try {
    for (;;) {
      for (std::size_t i = 0; i < counts.size(); ++i) runs[i] = runs[i] && go_on(counts[i]);
      if (std::find(runs.begin(), runs.end(), true) == runs.end()) break;
      double step = seconds_of([&] { simulation.step(); });
      const double detection = simulation.scene().result().stats.total_seconds;
      step *= simulation.motion_seconds() / (simulation.motion_seconds() + detection);
      if (simulation.step_count() % StrainSampler::every == 0) sampler.add(simulation, strain);
      for (std::size_t i = 0; i < counts.size(); ++i) {
        if (!runs[i]) continue;
        ++counts[i].steps;
        counts[i].motion_seconds += step;
        counts[i].strain = strain;
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

RunLog::RunLog(const std::filesystem::path& folder, const std::string& name, bool resume) {
  const std::filesystem::path path = folder / (name + ".csv");
  const std::string header = csv_head() + csv_of(Table{name, run_columns});
  std::size_t length = 0;
  if (resume && std::filesystem::exists(path)) {
    const std::string text = cli::read_text(path);
    const CsvText csv = parse_csv(text);
    if (!csv.rows.empty() && csv.rows.front() != run_columns)
      throw Error(
          fmt::format("{}: has other run_columns than this program writes; leave out --resume to start again",
                      path.string()));
    for (std::size_t i = 1; i < csv.rows.size(); ++i) {
      const std::vector<std::string>& row = csv.rows[i];
      const auto is_number = [](const std::string& field) {
        return field.find_first_not_of("0123456789.+-e") == std::string::npos;
      };
      if (row.size() != run_columns.size() ||
          !std::all_of(row.begin() + key_columns, row.end() - 1, is_number))
        throw Error(fmt::format("{}: row {} is not a run; remove it, or leave out --resume to start again",
                                path.string(), i));
      done_.insert(csv_of(std::vector<Cell>(row.begin(), row.begin() + key_columns)));
    }
    length = csv.length;
    // A program that was killed leaves an incomplete line behind.
    if (length < text.size()) std::filesystem::resize_file(path, length);
  }
  file_.emplace(path.string(), length > 0 ? cli::OutputFile::Mode::append : cli::OutputFile::Mode::replace);
  if (length == 0) std::fwrite(header.data(), 1, header.size(), file_->stream());
  std::fflush(file_->stream());
  file_->check();
}

bool RunLog::has(const std::vector<Cell>& key) const {
  return done_.contains(csv_of(key));
}

void RunLog::add(std::vector<Cell> row, const RunCounts& run) {
  row.insert(row.end(), {run.broad, run.narrow, run.exact, run.steps, run.bounds_seconds,
                         run.detection_seconds, run.motion_seconds, run.strain.mean, run.strain.least,
                         run.strain.most, run.strain.largest, run.failure});
  const std::string line = csv_of(row);
  std::fwrite(line.data(), 1, line.size(), file_->stream());
  std::fflush(file_->stream());
  file_->check();
}

bool run_all(const std::vector<Motion>& motions, const RunOptions& options, RunLog& log,
             const cli::Interruption& interruption, bool show_progress) {
  constexpr double ticks = 64;  // of progress in a second of a run
  struct Task {
    Motion motion;  ///< with the variants that the log has not
    std::uint64_t seed, steps;
    std::vector<std::vector<Cell>> keys{};
  };
  std::vector<Task> tasks;
  double total = 0;
  // In the order of the table, so that an interrupted experiment has complete rows.
  for (const Motion& motion : motions) {
    const cli::Input input =
        read_scene(motion.scene, motion.variants.front().method.integrator, options.seed);
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
