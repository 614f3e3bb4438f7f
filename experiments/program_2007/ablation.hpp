#pragma once

#include <cstdint>

#include "report.hpp"

namespace supple::experiments {

struct AblationOptions {
  bool with_bikes = true;
  int frames = 100;  ///< of each scene, ≥ 1
  int rounds = 7;    ///< ≥ 2
  std::uint32_t threads = 1;
  std::uint64_t seed = 1;
};

AblationOptions ablation_options(bool quick);

/// From the program of 2007 to the defaults of today, one choice at a time, on the same motion: time of a
/// step by stage, tests and memory; and the defaults with narrower vectors.
Report run_ablation(const AblationOptions& options, bool show_progress);

}  // namespace supple::experiments
