#include "simulate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "build_simulation.hpp"
#include "energy_table.hpp"
#include "exit_status.hpp"
#include "frame_recorder.hpp"
#include "inputs.hpp"
#include "interruption.hpp"
#include "missing_threads.hpp"
#include "output_names.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "session/long_steps.hpp"
#include "supple/error.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

using Clock = std::chrono::steady_clock;

Input read_input(const SimulateOptions& options) {
  if (!is_scene_file(options.input))
    throw Error(fmt::format(
        "{}: is not a scene file; write a SCENE.toml with an [[object]] that has this file as its mesh",
        options.input));
  return read_objects({options.input}, {options.seed, options.time_step});
}

/// The number of steps: they reach the given time and end less than one step after it.
std::uint64_t count_steps(const SimulateOptions& options, double time_step) {
  constexpr std::uint64_t default_frames = 301;
  if (!options.seconds) return options.frames.value_or(default_frames) - 1;
  const double steps = *options.seconds / time_step;
  if (steps > 1e9)
    throw Error(fmt::format("--seconds: {} are {:.3g} steps of {}; at most 1e9 are allowed", *options.seconds,
                            steps, time_step));
  const double whole = std::round(steps);
  const bool is_whole = std::abs(steps - whole) < 1e-9 * whole;  // up to rounding of the division
  return static_cast<std::uint64_t>(is_whole ? whole : std::ceil(steps));
}

/// A running simulation and its reports.
class Run {
 public:
  Run(const SimulateOptions& options, const Input& input)
      : options_(options),
        steps_(count_steps(options, input.simulation.time_step)),
        simulation_(build_simulation(input)),
        reports_(options, input, simulation_.scene(), "frame"),
        recorder_(options.record, simulation_, input),
        energies_(simulation_) {}

  /// Runs until the last step, an interruption or a blow-up. Returns the exit status.
  int go();

 private:
  bool take_steps(const Interruption& interruption);
  void add_frame(const DetectResult& result);
  void finish(double seconds);
  int status_of_interruption(int signal) const;

  const SimulateOptions& options_;
  std::uint64_t steps_;
  Simulation simulation_;
  Reports reports_;
  FrameRecorder recorder_;
  EnergyTable energies_;
};

int Run::go() {
  if (const auto warning = viewer::warning_of_long_steps(simulation_))
    fmt::print(stderr, "supple: warning: {}: {}\n", one_line(options_.input), one_line(*warning));
  const Interruption interruption;
  const Clock::time_point start = Clock::now();
  add_frame(simulation_.detect());
  const bool stable = take_steps(interruption);
  finish(std::max(std::chrono::duration<double>(Clock::now() - start).count(), 0.0));
  if (!stable) return exit_unusable;
  return interruption.signal() == 0 ? reports_.exit_status() : status_of_interruption(interruption.signal());
}

/// False when the motion blew up.
bool Run::take_steps(const Interruption& interruption) {
  Progress progress(steps_, !options_.quiet, "step");
  std::optional<std::string> fault;
  while (simulation_.step_count() < steps_ && interruption.signal() == 0) {
    try {
      add_frame(simulation_.step());
    } catch (const MotionError& error) {
      fault = error.what();
      break;
    }
    const std::uint64_t done = simulation_.step_count();
    progress.update(done, fmt::format("step {} of {}", done, steps_));
  }
  if (fault) fmt::print(stderr, "supple: {}: {}\n", one_line(options_.input), one_line(*fault));
  return !fault;
}

void Run::add_frame(const DetectResult& result) {
  const std::uint64_t number = simulation_.step_count();
  Frame frame{number, result};
  frame.simulated = {simulation_.time(), number == 0 ? 0 : simulation_.motion_seconds()};
  const bool is_start_of_continuous =
      number == 0 && contains(options_.scene.contacts, ContactKinds::continuous);
  if (options_.verify && !is_start_of_continuous) frame.verify = simulation_.scene().verify();
  recorder_.add(result);
  reports_.add(frame);
}

void Run::finish(double seconds) {
  recorder_.close();
  if (reports_.has_tables()) {
    const auto steps = static_cast<double>(simulation_.step_count());
    fmt::print("{} of {} s: {:.6g} s simulated in {:.3g} s, {:.3g} steps/s\n",
               counted(simulation_.step_count(), "step"), simulation_.options().time_step, simulation_.time(),
               seconds, seconds > 0 ? steps / seconds : 0);
  }
  reports_.finish();
  if (reports_.has_tables()) energies_.print(simulation_);
}

int Run::status_of_interruption(int signal) const {
  fmt::print(stderr, "supple: interrupted after step {} of {}, {:.6g} s{}\n", simulation_.step_count(),
             steps_, simulation_.time(),
             options_.record.empty() ? ""
                                     : fmt::format("; {} has {}", one_line(options_.record),
                                                   counted(simulation_.step_count() + 1, "frame")));
  return exit_interrupted + signal;
}

}  // namespace

int run_simulate(const SimulateOptions& options) {
  Input input = read_input(options);
  print_notes(input);
  std::string xdmf;
  if (!options.record.empty())
    xdmf = std::filesystem::path(options.record).replace_extension(".xdmf").string();
  check_output_names({{"--json", options.json},
                      {"--csv", options.csv},
                      {"--record", options.record},
                      {"the .xdmf file of --record", xdmf}},
                     input.files);
  apply(options, input);
  warn_of_missing_threads(options.scene.threads);
  return Run(options, input).go();
}

}  // namespace supple::cli
