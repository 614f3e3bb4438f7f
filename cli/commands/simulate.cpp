#include "commands/commands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "base/interruption.hpp"
#include "base/progress.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "commands/build_simulation.hpp"
#include "inputs/inputs.hpp"
#include "reports/reports.hpp"
#include "supple/recording.hpp"

namespace supple::cli {
namespace {

using Clock = std::chrono::steady_clock;

Input read_input(const SimulateOptions& options) {
  if (!is_scene_file(options.input))
    fail("{}: is not a scene file; write a SCENE.toml with an [[object]] that has this file as its mesh",
         options.input);
  return read_objects({options.input}, {options.seed, options.time_step});
}

/// The number of steps: they reach the given time and end less than one step after it.
std::uint64_t count_steps(const SimulateOptions& options, double time_step) {
  constexpr std::uint64_t default_frames = 301;
  if (!options.seconds) return options.frames.value_or(default_frames) - 1;
  const double steps = *options.seconds / time_step;
  if (steps > 1e9)
    fail("--seconds: {} are {:.3g} steps of {}; at most 1e9 are allowed", *options.seconds, steps, time_step);
  const double whole = std::round(steps);
  const bool is_whole = std::abs(steps - whole) < 1e-9 * whole;  // up to rounding of the division
  return static_cast<std::uint64_t>(is_whole ? whole : std::ceil(steps));
}

void print_energy(const std::string& name, double start, const MassSpringEnergy& end) {
  fmt::print("{:<20} {:>13.6g} {:>13.6g} {:>11.4g} {:>11.4g} {:>11.4g} {:>11.4g} {:>11.4g}\n", name, start,
             end.total(), end.kinetic, end.elastic, end.area, end.volume, end.gravity);
}

/// A table of the energy of each body of masses and springs at the start and at the end.
void print_energies(const Input& input, const std::vector<BodyEnergy>& start,
                    const std::vector<BodyEnergy>& end) {
  if (end.empty()) return;
  fmt::print("\n{:<20} {:>13} {:>13} {:>11} {:>11} {:>11} {:>11} {:>11}\n", "energy, J", "at the start",
             "at the end", "kinetic", "elastic", "area", "volume", "gravity");
  double all_at_start = 0;
  MassSpringEnergy all;
  for (std::size_t i = 0; i < end.size(); ++i) {
    const MassSpringEnergy& energy = end[i].energy;
    all_at_start += start[i].energy.total();
    all.kinetic += energy.kinetic;
    all.elastic += energy.elastic;
    all.area += energy.area;
    all.volume += energy.volume;
    all.gravity += energy.gravity;
    if (i < most_rows) print_energy(name_of(input, end[i].object), start[i].energy.total(), energy);
  }
  if (end.size() > most_rows) fmt::print("and {} more\n", counted(end.size() - most_rows, "object"));
  if (end.size() > 1) print_energy("all", all_at_start, all);
}

RecordingHeader header_of(const Input& input, const MovingObjects& objects, const Ranks& ranks) {
  RecordingHeader header;
  header.ranks = static_cast<std::uint32_t>(ranks.size());
  header.time_step = input.simulation.time_step;
  header.scene = input.simulation.scene;
  header.scene_file = input.scene_text;
  for (std::uint32_t i = 0; i < input.objects.size(); ++i) {
    const InputObject& object = input.objects[i];
    if (const int rank = objects.rank_of({i}); rank != ranks.rank()) {
      const RecordedElsewhere elsewhere{static_cast<std::uint32_t>(rank), object.mesh.positions.size(),
                                        object.mesh.triangles.size()};
      header.objects.push_back({{i}, object.options, {}, {}, elsewhere});
      continue;
    }
    header.objects.push_back(recorded_object({i}, object, input.simulation.border));
  }
  return header;
}

/// Records a simulation frame by frame. Each rank writes the objects that it moves. All calls but `add` are
/// collective.
class FrameRecorder {
 public:
  FrameRecorder(Ranks& ranks, const MovingObjects& objects) : ranks_(ranks), objects_(objects) {}

  /// Creates the files.
  void start(const std::string& file_name, const Input& input) {
    if (file_name.empty()) return;
    is_on_ = true;
    for (std::uint32_t i = 0; i < input.objects.size(); ++i) ids_.push_back({i});
    const int rank = ranks_.rank();
    const auto run = static_cast<std::uint32_t>(
        ranks_.largest(rank == 0 ? static_cast<int>(std::random_device()() >> 1) : 0));
    const auto create = [&] {
      recorder_.emplace(file_name, header_of(input, objects_, ranks_),
                        RecordingRank{static_cast<std::uint32_t>(rank), run});
    };
    ranks_.together([&] {
      const auto is_own = [&](ObjectId object) { return objects_.rank_of(object) == rank; };
      if (rank == 0 || std::ranges::any_of(ids_, is_own)) create();
    });
    ranks_.others_first([&] { flush(); });
  }

  /// Adds a frame: where the objects are now, and the result of the detection.
  void add(const DetectResult& result) {
    if (!recorder_) return;
    positions_.clear();
    for (const ObjectId object : ids_) {
      const bool is_own = objects_.rank_of(object) == ranks_.rank();
      positions_.push_back(is_own ? objects_.positions(object) : std::span<const Vec3d>());
    }
    recorder_->add(objects_.time(), positions_, result);
  }

  void flush_if_due() {
    if (is_on_ && ranks_.largest(recorder_ && recorder_->needs_flush() ? 1 : 0) != 0)
      ranks_.others_first([this] { flush(); });
  }

  void close() {
    if (!is_on_) return;
    ranks_.others_first([this] {
      if (recorder_) recorder_->close();
    });
  }

 private:
  void flush() {
    if (recorder_) recorder_->flush();
  }

  Ranks& ranks_;
  const MovingObjects& objects_;
  bool is_on_ = false;  ///< on all ranks
  std::vector<ObjectId> ids_;
  std::vector<std::span<const Vec3d>> positions_;
  std::optional<Recorder> recorder_;  ///< on ranks that have objects, and on rank 0
};

/// A running simulation and its reports.
class Run {
 public:
  Run(const SimulateOptions& options, const Input& input, Ranks& ranks, MovingObjects& objects)
      : options_(options),
        time_step_(input.simulation.time_step),
        steps_(count_steps(options, time_step_)),
        is_continuous_(contains(options.scene.contacts, ContactKinds::continuous)),
        ranks_(ranks),
        objects_(objects),
        reports_(options, input, objects, "frame"),
        recorder_(ranks, objects),
        input_(input) {}

  void start_recording(const Input& input) { recorder_.start(options_.record, input); }

  /// Runs until the last step, an interruption or a blow-up. Returns the exit status.
  int go() {
    energies_at_start_ = objects_.energies();
    if (const auto warning = objects_.warning_of_long_steps(); warning && ranks_.rank() == 0)
      fmt::print(stderr, "supple: warning: {}: {}\n", one_line(options_.input), one_line(*warning));
    Interruption interruption(options_.limits.seconds, [this](const Interruption& end) {
      if (ranks_.size() > 1) return;
      recorder_.close();
      exit_now(end_early(end, Moment::in_a_step));
    });
    start_ = Clock::now();
    const bool is_whole =
        !is_ended(interruption, ranks_) && add_frame(interruption, objects_.detect(request_of(interruption)));
    const bool stable = !is_whole || take_steps(interruption);
    interruption.end();
    energies_at_end_ = objects_.energies();
    recorder_.close();
    int status = exit_unusable;
    if (stable && frames_ < steps_ + 1) share_signal(interruption, ranks_);
    ranks_.together([&] {
      if (stable && frames_ < steps_ + 1) {
        status = end_early(interruption, Moment::between_steps);
        return;
      }
      finish(false);
      if (reports_.has_tables()) print_energies(input_, energies_at_start_, energies_at_end_);
      if (stable) status = reports_.exit_status();
    });
    return status;
  }

 private:
  /// False when the motion blew up.
  bool take_steps(Interruption& interruption) {
    Progress progress(steps_, !options_.quiet, "step");
    std::optional<std::string> fault;
    while (objects_.step_count() < steps_ && !is_ended(interruption, ranks_)) {
      if (is_continuous_) objects_.remember_positions();
      try {
        if (!add_frame(interruption, objects_.step(request_of(interruption)))) break;
      } catch (const MotionError& error) {
        fault = error.what();
        break;
      }
      const std::uint64_t done = objects_.step_count();
      progress.update(done, fmt::format("step {} of {}", done, steps_));
    }
    if (fault && ranks_.rank() == 0) fmt::print(stderr, "supple: {}: {}\n", one_line(options_.input), *fault);
    return !fault;
  }

  /// Returns false when the detection was stopped.
  bool add_frame(Interruption& interruption, const DetectResult& result) {
    if (result.stopped) return false;
    const std::uint64_t number = objects_.step_count();
    Frame frame{number, result};
    frame.simulated = {objects_.time(), number == 0 ? 0 : objects_.motion_seconds()};
    if (is_continuous_ && number > 0) frame.turned = objects_.turned();
    if (options_.verify && !(number == 0 && is_continuous_))
      frame.verify = objects_.verify({interruption.token()});
    if (frame.verify && frame.verify->stopped) return false;
    const auto hold = interruption.hold();
    ranks_.together([&] {
      recorder_.add(result);
      reports_.add(frame);
    });
    recorder_.flush_if_due();
    frames_ = number + 1;
    time_ = objects_.time();
    return true;
  }

  void finish(bool was_ended) {
    if (reports_.has_tables() && frames_ > 0) {
      const double seconds = std::max(std::chrono::duration<double>(Clock::now() - start_).count(), 0.0);
      const auto steps = static_cast<double>(frames_ - 1);
      fmt::print("{} of {} s: {:.6g} s simulated in {:.3g} s, {:.3g} steps/s\n", counted(frames_ - 1, "step"),
                 time_step_, time_, seconds, seconds > 0 ? steps / seconds : 0);
    }
    reports_.finish(was_ended);
  }

  enum class Moment { between_steps, in_a_step };

  /// Reports the frames so far. Returns the exit status.
  int end_early(const Interruption& interruption, Moment moment) {
    finish(true);
    if (ranks_.rank() != 0) return exit_done;
    // In a step, another thread changes the simulation.
    if (reports_.has_tables() && moment == Moment::between_steps)
      print_energies(input_, energies_at_start_, energies_at_end_);
    std::string place = fmt::format("{} of {}, {:.6g} s", grouped(frames_ == 0 ? 0 : frames_ - 1),
                                    counted(steps_, "step"), time_);
    if (!options_.record.empty())
      place += fmt::format("; {} has {}", one_line(options_.record), counted(frames_, "frame"));
    return report_end(interruption, options_.limits.seconds, place,
                      interruption.signal() != 0 ? exit_done : reports_.exit_status());
  }

  static DetectRequest request_of(const Interruption& interruption) { return {.stop = interruption.token()}; }

  const SimulateOptions& options_;
  double time_step_;
  std::uint64_t steps_;
  bool is_continuous_;
  Ranks& ranks_;
  MovingObjects& objects_;
  Reports reports_;
  FrameRecorder recorder_;
  const Input& input_;
  std::vector<BodyEnergy> energies_at_start_, energies_at_end_;
  Clock::time_point start_ = Clock::now();
  std::uint64_t frames_ = 0;  ///< that were added
  double time_ = 0;           ///< simulated, s, of the last of them
};

}  // namespace

int run_simulate(const SimulateOptions& given, Ranks& ranks) {
  const SimulateOptions options = options_of_rank(given, ranks);
  Input input;
  ranks.together([&] {
    input = read_input(options);
    std::string xdmf;
    if (!options.record.empty())
      xdmf = std::filesystem::path(options.record).replace_extension(".xdmf").string();
    check_output_names({{"--json", options.json},
                        {"--csv", options.csv},
                        {"--record", options.record},
                        {"the .xdmf file of --record", xdmf}},
                       input.files);
    apply(options, input);
    if (ranks.rank() == 0) print_notes(input);
    ranks.check(options, input);
  });
  if (ranks.size() == 1) warn_of_missing_threads(options.scene.threads);
  const std::unique_ptr<MovingObjects> objects = ranks.move(input, !options.record.empty());
  std::optional<Run> run;
  ranks.together([&] { run.emplace(options, input, ranks, *objects); });
  run->start_recording(input);
  objects->release_meshes(input);
  return run->go();
}

}  // namespace supple::cli
