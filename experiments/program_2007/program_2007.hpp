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

/// The data of the paper's five figures, from the method of 2007 on table1_9: the modules and their times
/// (1), the regions of the scene octree (2, 3), the pairs of nodes of a collision (4) and their boxes (5).
/// Also writes what has no table into the folder: the meshes (figures.obj), the positions of each frame as
/// floats (figures_positions.f32: frames × vertices × 3), the regions and the spheres of each frame
/// (figures_regions.csv, figures_spheres.csv), and the boxes of the colliding leaves (figures_boxes.csv).
Results run_figures(const Request& request);

}  // namespace supple::experiments
