#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace supple {

/// Points with the numbers of their triangles, one array per axis.
struct PointArrays {
  std::array<float*, 3> at;
  std::uint32_t* triangles;

  PointArrays from(std::size_t first) const {
    return {{at[0] + first, at[1] + first, at[2] + first}, triangles + first};
  }
};

struct PointBox {
  std::array<float, 3> low, high;

  float extent(std::size_t axis) const { return high[axis] - low[axis]; }
  /// The first of equally long axes.
  std::size_t longest_axis() const {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) longest = extent(axis) > extent(longest) ? axis : longest;
    return longest;
  }
};

/// `partition_points` may write so many points behind the last one of `upper`.
constexpr std::size_t points_ahead = 16;

PointBox box_of_points(const PointArrays& points, std::size_t count);

/// Sets `cell_of_point[i]` to the cell along an axis that contains coordinate i: the smaller of `cells` - 1
/// and (`coordinates[i]` - `low`) * `scale`, rounded down, which must not be negative. `cells` is at most
/// 2^16.
void number_cells(const float* coordinates, std::size_t count, float low, float scale, std::uint32_t cells,
                  std::uint16_t* cell_of_point);

/// Puts the points in cells below `border` first, keeps the order of both sides, and returns the number of
/// these points. `upper` is scratch memory for as many points and `points_ahead` more.
std::uint32_t partition_points(const PointArrays& points, std::size_t count,
                               const std::uint16_t* cell_of_point, std::uint32_t border,
                               const PointArrays& upper);

}  // namespace supple
