#include "detect.hpp"

#include <fmt/core.h>

#include <string>

#include "build_simulation.hpp"
#include "inputs.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "supple/error.hpp"

namespace supple::cli {
namespace {

Input read_input(const DetectOptions& options) {
  Input input = options.sequence ? read_sequence(options.inputs) : read_objects(options.inputs);
  if (options.steps > 1 && !is_scene_file(options.inputs.front()))
    throw Error("--steps: only a scene file has steps; leave it out, or give frames with --sequence");
  return input;
}

/// How often contacts are looked for: in each frame, or from each frame to the next.
std::uint64_t count_steps(const Input& input, const DetectOptions& options) {
  if (!input.frames) return options.steps;
  if (!contains(options.scene.contacts, ContactKinds::continuous)) return input.frames->count;
  if (input.frames->count < 2)
    throw Error(fmt::format("{}: one frame is no motion; continuous contacts need two frames or more",
                            input.frames->name));
  return input.frames->count - 1;
}

}  // namespace

int run_detect(const DetectOptions& options) {
  const Input input = read_input(options);
  const std::uint64_t steps = count_steps(input, options);
  Simulation simulation = build_simulation(input, options);

  const bool continuous = contains(options.scene.contacts, ContactKinds::continuous);
  const char* const noun = continuous ? "step" : "frame";
  Reports reports(options, simulation.scene(), noun);
  Progress progress(steps, !options.quiet, noun);
  for (std::uint64_t number = 0; number < steps; ++number) {
    Frame frame{number, continuous || number > 0 ? simulation.step() : simulation.detect()};
    if (options.verify) frame.verify = simulation.scene().verify();
    reports.add(frame);
    progress.update(number + 1, fmt::format("{} {} of {}", noun, number + 1, steps));
  }
  reports.finish();
  return reports.exit_status();
}

}  // namespace supple::cli
