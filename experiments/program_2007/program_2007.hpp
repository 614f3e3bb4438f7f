#pragma once

#include "results.hpp"

namespace supple::experiments {

/// From the program of 2007 to the defaults of today, one choice at a time, on the same motion: time of a
/// step by stage, tests and memory; and the defaults with narrower vectors. One thread. The loop that makes
/// the boxes of the programs with the lazy refit is timed, too.
Results run_ablation(const Request& request);

/// The methods that the paper tried and rejected: in the narrow phase the neighbours of vertices, the regions
/// of the scene octree and the common region (6), in the broad phase an octree of spheres (5.1). Each is a
/// small program of this experiment, compared with the hierarchy that the paper chose.
Results run_trials(const Request& request);

/// The data of the paper's figures, from the method of 2007 on table1_9: the modules and their times (1), and
/// at a collision the regions of the scene octree (2) and the pairs of nodes (4). The heads of the tables say
/// which frames, objects and place figures 3 and 5 show.
Results run_figures(const Request& request);

}  // namespace supple::experiments
