#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/types.hpp"

namespace supple {

/// How `BulkSearch` divides space: chosen from a sample of the boxes, and the same for the same boxes.
struct SearchPlan {
  /// Boxes whose extents are no larger along any axis, x, y, z, and which belong to no level before; cells of
  /// these sizes hold them. Of the last level all that are left, whatever their extents.
  struct Level {
    std::array<double, 3> largest{}, cell{};
  };
  std::array<double, 3> low{}, high{};       ///< where nearly all boxes are, x, y, z; high is above low
  std::array<std::size_t, 3> axes{0, 1, 2};  ///< along rows, then the second, the third
  std::vector<Level> levels;
};

/// O(sample).
class SearchPlanner {
 public:
  void choose(std::span<const Aabb> boxes, SearchPlan& plan);

 private:
  struct Sampled {
    std::array<float, 3> low, high;
    double size;  // the largest extent, in mean extents
  };
  void sample(std::span<const Aabb> boxes);
  void bound(SearchPlan& plan);
  void measure_extents();
  void choose_axes(SearchPlan& plan);
  bool suits_one_row(const SearchPlan& plan) const;
  void add_row(SearchPlan& plan);
  void measure_sizes();
  double crowding(const SearchPlan& plan);
  void choose_levels(SearchPlan& plan);

  std::vector<Sampled> sampled_;
  std::vector<float> scratch_;
  std::vector<std::uint32_t> cells_;
  std::array<double, 3> mean_extent_{}, width_{};  // width in mean extents
  std::size_t count_ = 0;
};

}  // namespace supple
