#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace supple::experiments {

/// Options of `supple experiment`.
struct ExperimentOptions {
  enum class Kind { table1, scaling, arity };
  Kind kind = Kind::table1;
  bool quick = false;
  bool quiet = false;
  std::string output;  ///< folder; empty: experiment_ and the kind
  /// Without a value: one per core for `table1`; one thread for the others, so that times measure work.
  std::optional<std::uint32_t> threads{};
  std::uint64_t seed = 1;
  // For table1; without a value, --quick decides.
  std::optional<std::uint32_t> runs{};
  std::optional<std::uint32_t> simulated_seconds{};
  std::optional<std::uint32_t> wall_clock{};  ///< seconds of real time per run; none: count only by events
};

const char* name_of(ExperimentOptions::Kind kind);

/// Runs an experiment, writes its files and prints its tables. Returns the exit status of the program.
int run_experiment(const ExperimentOptions& options);

}  // namespace supple::experiments
