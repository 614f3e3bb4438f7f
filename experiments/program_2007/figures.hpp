#pragma once

#include <cstdint>
#include <filesystem>

#include "results.hpp"

namespace supple::experiments {

struct FiguresOptions {
  int frames = 60;  ///< one per step, around the collision of figures 3 to 5
  std::uint64_t seed = 1;
};

FiguresOptions figures_options(bool quick);

/// The data of the paper's five figures, from the method of 2007 on table1_9: the modules and their times
/// (1), the regions of the scene octree (2, 3), the pairs of nodes of a collision (4) and their boxes (5).
/// Also writes what has no table into the folder: the meshes (figures.obj), the positions of each frame as
/// floats (figures_positions.f32: frames × vertices × 3), the regions and the spheres of each frame
/// (figures_regions.csv, figures_spheres.csv), and the boxes of the colliding leaves (figures_boxes.csv).
Results run_figures(const FiguresOptions& options, const std::filesystem::path& folder, bool show_progress);

}  // namespace supple::experiments
