#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "options/option_kinds.hpp"
#include "table1/table1_options.hpp"

namespace supple::experiments {

/// Options of `supple experiment`.
struct ExperimentOptions {
  std::string name;  ///< of the experiment
  bool quick = false;
  bool quiet = false;
  std::string output;                      ///< folder; empty: experiment_ and the name
  std::optional<std::uint32_t> threads{};  ///< parallel runs of table1 and sensitivity; none: one per core
  std::uint64_t seed = 1;
  // For table1; without a value, --quick decides.
  std::vector<std::uint32_t> objects{};  ///< of mixed scenes; these and `scenes` replace the built-in scenes
  std::vector<std::string> scenes{};     ///< scene files
  std::vector<double> scene_sizes{};     ///< edges of the border, for every scene
  Table1Method method{};
  std::optional<std::uint32_t> runs{};
  std::optional<std::uint32_t> simulated_seconds{};  ///< 0: no runs in simulated time
  std::optional<std::uint32_t> program_clock{};      ///< of detection and motion per run; none: no such runs
  bool resume = false;

  /// Whether its runs are in a log, so that it can be resumed.
  bool has_log() const { return name == "table1" || name == "sensitivity"; }
};

/// The names of the experiments, and what each does, for the help.
std::vector<std::pair<std::string, std::string>> experiments();

/// Adds the options and the footer of the help to the command `experiment`.
void add_options(CLI::App& experiment, ExperimentOptions& options, cli::Dependences& dependences);

/// Runs an experiment, writes its files and prints the verdicts on the claims. Returns the exit status of the
/// program.
int run_experiment(const ExperimentOptions& options);

}  // namespace supple::experiments
