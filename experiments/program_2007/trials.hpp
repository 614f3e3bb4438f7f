#pragma once

#include <cstdint>

#include "results.hpp"

namespace supple::experiments {

struct TrialOptions {
  bool with_humans = true;
  int frames = 100;  ///< of each scene, ≥ 1
  int rounds = 7;    ///< ≥ 2
  std::uint64_t seed = 1;
};

TrialOptions trial_options(bool quick);

/// The methods that the paper tried and rejected: in the narrow phase the neighbours of vertices, the regions
/// of the scene octree and the common region (6), in the broad phase an octree of spheres (5.1). Each is a
/// small program of this experiment, compared with the hierarchy that the paper chose.
Results run_trials(const TrialOptions& options, bool show_progress);

}  // namespace supple::experiments
