#pragma once

#include <cstddef>
#include <cstdint>

#include "experiments/report.hpp"
#include "experiments/work.hpp"

namespace supple::experiments {

struct ArityOptions {
  bool quick = false;
  int frames = 5;  ///< ≥ 1; the fastest counts
  std::uint32_t threads = 1;
  std::uint64_t seed = 1;
};

/// Trees of two, four and eight children, of objects and of the scene.
Report run_arity(const ArityOptions& options, bool show_progress);

}  // namespace supple::experiments
