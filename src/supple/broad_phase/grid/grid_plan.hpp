#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "broad_phase/grid/grid_kernel.hpp"

namespace supple {

/// Chooses bounds, axes, levels and cells of a grid from a sample of the boxes. The same boxes give the same
/// grid.
class GridPlanner {
 public:
  /// O(sample). `max_extent` of the levels is 0.
  void plan(std::span<const Aabb> boxes, Grid& grid);

 private:
  struct Sample {
    std::array<float, 3> low{}, high{};
    double size = 0;  // the largest extent, in mean extents
  };
  void take_sample(std::span<const Aabb> boxes);
  void choose_bounds(Grid& grid);
  void choose_axes(Grid& grid);
  void choose_levels(Grid& grid);
  void add_level(Grid& grid, double count, double size) const;

  double count_ = 0;  // of all boxes
  std::vector<Sample> samples_;
  std::vector<float> scratch_;
  // By x, y, z.
  std::array<double, 3> low_{}, high_{};  // contain nearly all boxes
  std::array<double, 3> mean_extent_{}, width_in_extents_{};
};

}  // namespace supple
