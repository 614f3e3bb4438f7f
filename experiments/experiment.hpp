#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "table1/table1_options.hpp"

namespace supple::experiments {

/// Options of `supple experiment`.
struct ExperimentOptions {
  enum class Kind { table1, scaling, arity, volumes, claims, ablation, trials, sensitivity, figures };
  Kind kind = Kind::table1;
  bool quick = false;
  bool quiet = false;
  std::string output;                      ///< folder; empty: experiment_ and the kind
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
};

/// In the order of `Kind`.
inline const std::array<std::string, 9> experiment_names{
    "table1", "scaling", "arity", "volumes", "claims", "ablation", "trials", "sensitivity", "figures"};
const std::string& name_of(ExperimentOptions::Kind kind);

/// Runs an experiment, writes its files and prints the verdicts on the claims. Returns the exit status of the
/// program.
int run_experiment(const ExperimentOptions& options);

}  // namespace supple::experiments
