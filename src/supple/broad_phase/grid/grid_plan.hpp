#pragma once

#include <array>
#include <span>
#include <vector>

#include "broad_phase/grid/grid_kernel.hpp"
#include "broad_phase/volume_store.hpp"

namespace supple {

/// Chooses bounds, axes, levels and cells of a grid from a sample of the boxes. The same boxes give the same
/// grid.
class GridPlanner {
 public:
  /// O(sample). `max_extent` of the levels is 0.
  void plan(const VolumeStore& volumes, Grid& grid);

 private:
  struct Sample {
    std::array<float, 3> low{}, high{};
    double size = 0;  // the largest extent, in mean extents
    std::size_t kind = 0;
  };
  void take_sample(const VolumeStore& volumes);
  void choose_bounds(Grid& grid);
  void choose_axes(Grid& grid);
  void measure_sizes();
  void choose_levels(std::size_t kind, std::span<const Sample> samples, Grid& grid) const;
  static void pair_levels(const WantedKinds& wanted, std::vector<GridLevel>& levels);
  void add_level(Grid& grid, std::size_t kind, double count, double size) const;

  double count_ = 0;  // of all boxes
  std::vector<Sample> samples_;
  std::vector<float> scratch_;
  // By x, y, z.
  std::array<double, 3> low_{}, high_{};  // contain nearly all boxes
  std::array<double, 3> mean_extent_{}, width_in_extents_{};
};

}  // namespace supple
