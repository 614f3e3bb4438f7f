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
  /// Of `table1` none: one a core. Of the others none: one thread, so that times are work.
  std::optional<std::uint32_t> threads{};
  std::uint64_t seed = 1;
  // For table1; empty: as --quick says.
  std::optional<std::uint32_t> runs{};
  std::optional<std::uint32_t> simulated_seconds{};
  std::optional<std::uint32_t> wall_clock{};  ///< seconds a run; none: only by events
};

const char* name_of(ExperimentOptions::Kind kind);

/// Runs one, writes its files and prints its tables. Returns the program's exit status.
int run_experiment(const ExperimentOptions& options);

}  // namespace supple::experiments
