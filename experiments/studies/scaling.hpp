#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "program_2007/few_objects.hpp"
#include "report.hpp"
#include "work.hpp"

namespace supple::experiments {

struct ScalingOptions {
  std::vector<std::size_t> object_counts;  ///< ascending
  FewObjectsOptions few_objects;
  std::vector<std::uint32_t> frequencies;  ///< of icospheres, ascending: 20 f² triangles
  double brute_seconds = 5;                ///< brute force skips steps that would take longer
  int frames = 5;                          ///< in motion, ≥ 1; the fastest counts
  std::uint32_t threads = 1;
  std::uint64_t seed = 1;
};

ScalingOptions scaling_options(bool quick);

/// Measures time and tests against the number of objects and of vertices, and fits powers.
Report run_scaling(const ScalingOptions& options, bool show_progress);

}  // namespace supple::experiments
