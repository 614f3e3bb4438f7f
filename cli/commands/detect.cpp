#include "commands/commands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "base/interruption.hpp"
#include "base/progress.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "commands/build_simulation.hpp"
#include "inputs/inputs.hpp"
#include "options/option_needs.hpp"
#include "reports/reports.hpp"

namespace supple::cli {
namespace {

/// The number of frames of the longest sequence of files of an object; 0 without such a sequence.
std::uint64_t longest_sequence(const Input& input) {
  std::uint64_t longest = 0;
  for (const InputObject& object : input.objects) {
    if (const auto frames = frames_of(object)) longest = std::max(longest, frames->count);
  }
  return longest;
}

bool moves(const Input& input) {
  return std::any_of(input.objects.begin(), input.objects.end(),
                     [](const InputObject& object) { return object.motion.has_value(); });
}

std::uint64_t count_frames(const Input& input, const DetectOptions& options) {
  const bool continuous = contains(options.scene.contacts, ContactKinds::continuous);
  const bool is_scene = is_scene_file(options.inputs.front());
  std::uint64_t frames = 1;
  if (input.frames)
    frames = input.frames->count;
  else if (is_scene && moves(input))
    frames = std::max<std::uint64_t>(longest_sequence(input), continuous ? 2 : 1);
  if (options.frames) {
    if (!is_scene && *options.frames > frames)
      fail("--frames: {} has {}; give at most that number",
           input.frames ? input.frames->name : options.inputs.front(), counted(frames, "frame"));
    frames = *options.frames;
  }
  if (continuous && frames == 1 && (input.frames || moves(input)))
    fail("{}: one frame has no motion; continuous contacts need at least two frames",
         input.frames ? input.frames->name : options.inputs.front());
  return frames;
}

/// One mesh, or its frames, without a scene around it: it can only be near itself.
bool is_one_mesh(const std::vector<std::string>& inputs, const Input& input) {
  return input.objects.size() == 1 && !is_scene_file(inputs.front()) && !is_recording(inputs.front());
}

/// Reads the input, with the options of the command line.
Input read_input(const DetectOptions& options, Ranks& ranks) {
  MeshReading reading = options.reading;
  if (!is_recording(options.inputs.front())) reading.clips.frames = options.frames;
  Input input = options.sequence ? read_sequence(options.inputs, reading.conversion)
                                 : read_objects(options.inputs, {}, reading);
  check_output_names({{"--json", options.json}, {"--csv", options.csv}}, input.files);
  apply(options, input);
  if (ranks.rank() == 0) print_notes(input);
  if (is_one_mesh(options.inputs, input) && has_margins(options.scene))
    input.objects.front().options.self_collision = true;
  ranks.check(options, input);
  return input;
}

}  // namespace

int run_detect(const DetectOptions& given, Ranks& ranks) {
  const DetectOptions options = options_of_rank(given, ranks);
  Input input;
  std::uint64_t frames = 0;
  ranks.together([&] {
    input = read_input(options, ranks);
    frames = count_frames(input, options);
  });
  if (ranks.size() == 1) warn_of_missing_threads(options.scene.threads);
  const bool prints_text = !options.quiet && options.json != "-" && options.csv != "-";
  if (options.sequence && prints_text) {
    if (const std::string gaps = describe_gaps(input.files); !gaps.empty()) fmt::print("{}\n", gaps);
  }
  const std::unique_ptr<MovingObjects> objects = ranks.move(input, false);

  // Continuous contacts are found between the previous frame and this frame, so the first frame has none.
  const bool continuous = contains(options.scene.contacts, ContactKinds::continuous);
  const std::uint64_t first = options.scene.contacts == ContactKinds::continuous && frames > 1 ? 1 : 0;
  const char* const noun = continuous ? "step" : "frame";
  std::optional<Reports> reports;
  ranks.together([&] { reports.emplace(options, input, *objects, noun); });
  objects->release_meshes(input);
  std::uint64_t done = 0;
  const auto end_early = [&](const Interruption& end) {
    reports->finish(true);
    if (ranks.rank() != 0) return static_cast<int>(exit_done);
    const std::string place = fmt::format("{} of {}", grouped(done), counted(frames - first, noun));
    return report_end(end, options.limits.seconds, place,
                      end.signal() != 0 ? exit_done : reports->exit_status());
  };
  Interruption interruption(options.limits.seconds, [&](const Interruption& end) {
    if (ranks.size() == 1) exit_now(end_early(end));
  });
  {
    Progress progress(frames - first, !options.quiet, noun);
    for (std::uint64_t number = first; number < frames && !is_ended(interruption, ranks); ++number) {
      const bool is_start = number == 0 && !(continuous && frames == 1);
      const DetectRequest request{.max_contacts = options.limits.max_contacts, .stop = interruption.token()};
      if (continuous) objects->remember_positions();
      Frame frame{number, is_start ? objects->detect(request) : objects->step(request)};
      if (frame.result.stopped) break;
      if (continuous && !is_start) frame.turned = objects->turned();
      if (options.verify && !(is_start && continuous)) frame.verify = objects->verify({interruption.token()});
      if (frame.verify && frame.verify->stopped) break;
      const auto hold = interruption.hold();
      ranks.together([&] { reports->add(frame); });
      done = number - first + 1;
      progress.update(done, fmt::format("{} {} of {}", noun, done, frames - first));
    }
  }
  interruption.end();
  int status = exit_done;
  if (done < frames - first) share_signal(interruption, ranks);
  ranks.together([&] {
    if (done < frames - first) {
      status = end_early(interruption);
    } else {
      reports->finish();
      status = reports->exit_status();
    }
  });
  return status;
}

}  // namespace supple::cli
