#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "supple/options.hpp"

namespace supple::cli {

/// Of `supple detect`.
struct DetectOptions {
  std::vector<std::string> inputs;  ///< meshes, patterns, or one scene file
  bool sequence = false;            ///< the inputs are frames of one object
  std::uint64_t steps = 1;          ///< of a scene file
  SceneOptions scene;
  bool self = false;
  std::optional<std::uint32_t> max_level, leaf_size;
  bool verify = false;
  bool fail_on_contact = false;
  bool quiet = false;
  bool json_stats = true;
  std::string json, csv;  ///< empty: none; "-": standard output
};

/// Of `supple info`.
struct InfoOptions {
  std::vector<std::string> inputs;
  std::optional<std::uint32_t> max_level, leaf_size;
  std::string json;
};

struct CommandLine {
  enum class Command { detect, info, exit };
  Command command = Command::exit;
  int exit_status = 0;  ///< of `Command::exit`: help, version or a usage error, already printed
  DetectOptions detect;
  InfoOptions info;
};

/// Prints help, version and generated documents to standard output, a usage error as one line to standard
/// error.
CommandLine parse_command_line(int argument_count, const char* const* arguments);

}  // namespace supple::cli
