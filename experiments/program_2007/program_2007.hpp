#pragma once

#include <cstdint>
#include <filesystem>

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
/// step by stage, tests and memory; and the defaults with narrower vectors. One thread. The loop that makes
/// the boxes of the programs with the lazy refit is timed, too.
Results run_ablation(const AblationOptions& options, bool show_progress);

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

struct FiguresOptions {
  int frames = 60;  ///< one per step, around the collision of figures 3 to 5
  std::uint64_t seed = 1;
};

FiguresOptions figures_options(bool quick);

/// The data of the paper's figures, from the method of 2007 on table1_9: the modules and their times (1), and
/// at a collision the regions of the scene octree (2) and the pairs of nodes (4). The heads of the tables say
/// which frames, objects and place figures 3 and 5 show.
Results run_figures(const FiguresOptions& options, const std::filesystem::path& folder, bool show_progress);

}  // namespace supple::experiments
