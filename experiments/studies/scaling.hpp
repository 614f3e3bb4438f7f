#pragma once

#include <cstdint>
#include <vector>

#include "results.hpp"
#include "studies/broad_phases.hpp"

namespace supple::experiments {

struct ScalingOptions {
  BroadPhasesOptions broad_phases{};
  std::vector<std::uint32_t> frequencies{8, 16, 32, 64, 128, 224};  ///< of icospheres, ascending: 20 f² triangles
  int rounds = 7;                                                   ///< in motion, ≥ 2
};

ScalingOptions scaling_options(bool quick, std::uint64_t seed);

/// Times and tests against the number of objects and of vertices.
Results run_scaling(const ScalingOptions& options, bool show_progress);

}  // namespace supple::experiments
