#pragma once

#include <cstdint>

#include "results.hpp"

namespace supple::experiments {

struct AblationOptions {
  bool with_bikes = true;
  int frames = 100;  ///< of each scene, ≥ 1
  int rounds = 7;    ///< ≥ 2
  std::uint64_t seed = 1;
};

AblationOptions ablation_options(bool quick);

/// From the program of 2007 to the defaults of today, one choice at a time, on the same motion: time of a
/// step by stage, tests and memory; and the defaults with narrower vectors. One thread. The loop that makes the
/// boxes of the programs with the lazy refit is timed, too.
Results run_ablation(const AblationOptions& options, bool show_progress);

}  // namespace supple::experiments
