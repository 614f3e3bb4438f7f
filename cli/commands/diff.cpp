#include "commands/commands.hpp"

#include <fmt/core.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "base/files.hpp"
#include "base/json_writer.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "supple/recording.hpp"

namespace supple::cli {
namespace {

void write_json(const DiffOptions& options, const Recording& a, const Recording& b,
                const std::optional<RecordingDifference>& difference) {
  JsonWriter json(options.json);
  json.list("recordings", options.recordings);
  json.key("frames");
  json.pair(a.frame_count(), b.frame_count());
  json.member("tolerance", options.tolerance);
  json.member("equal", !difference);
  json.member("frame", difference ? difference->frame : std::nullopt);
  json.member("what", difference ? std::optional(difference->what) : std::nullopt);
  json.close();
}

void print_text(const DiffOptions& options, const Recording& a,
                const std::optional<RecordingDifference>& difference) {
  const std::string both = one_line(fmt::format("{} and {}", options.recordings[0], options.recordings[1]));
  if (!difference)
    fmt::print("{} are equal: {}\n", both, counted(a.frame_count(), "frame"));
  else if (difference->frame)
    fmt::print("{} differ in frame {}: {}\n", both, *difference->frame, one_line(difference->what));
  else
    fmt::print("{} differ: {}\n", both, one_line(difference->what));
}

}  // namespace

int run_diff(const DiffOptions& options) {
  const std::array<std::filesystem::path, 2> inputs{options.recordings[0], options.recordings[1]};
  check_output_names({{"--json", options.json}}, inputs);
  const Recording a(options.recordings[0]), b(options.recordings[1]);
  const std::optional<RecordingDifference> difference = find_first_difference(a, b, options.tolerance);
  if (!options.json.empty()) write_json(options, a, b, difference);
  if (!options.quiet && options.json != "-") print_text(options, a, difference);
  return difference ? exit_differ : exit_done;
}

}  // namespace supple::cli
