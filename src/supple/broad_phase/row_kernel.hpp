#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broad_phase/box_lanes.hpp"
#include "broad_phase/pair_sorter.hpp"

namespace supple {

/// Steps along each axis in which `BulkSearch` measures boxes.
inline constexpr std::uint32_t kSteps = 1u << 16;

/// The boxes of like size, in the order in which they are searched: rows along the first axis, one behind the
/// other along the second and then the third, each divided into cells. A box is in the cell of its lower
/// corner.
struct BoxRows {
  std::array<std::uint32_t, 3> divisions{1, 1, 1};  ///< cells of a row, rows along the second and third axis
  std::array<std::uint32_t, 3> reach{};             ///< largest extent of these boxes, in steps
  std::uint32_t first_cell = 0;

  std::uint32_t division(std::size_t axis, std::uint32_t step) const {
    return step * divisions[axis] / kSteps;
  }
  std::uint32_t row_of(std::uint32_t second, std::uint32_t third) const {
    return division(2, third) * divisions[1] + division(1, second);
  }
  std::uint32_t row_count() const { return divisions[1] * divisions[2]; }
  std::uint32_t cell_count() const { return divisions[0] * row_count(); }
};

/// All boxes, by level of size, row and cell. Along each axis the lower half of a word is the step that the
/// lower end is in, and the upper half 65,535 less the step of the upper end; all steps are 1 to 65,534.
struct DealtBoxes {
  std::array<std::vector<std::uint32_t>, 3> ends;
  std::vector<std::uint32_t> slots;
  std::vector<std::uint32_t> cell_begins;     ///< per cell and one more
  bool is_dense = false;                      ///< a vector of lanes holds a pair more often than not
  std::vector<BoxRows> levels;                ///< from the smallest boxes to the largest
  std::span<const Aabb> exact;                ///< per slot
  std::span<const BoundingSphere> spheres{};  ///< per slot; where there are some, these decide
};

/// A box on its way into `DealtBoxes`, ends along x, y, z.
struct alignas(16) MeasuredBox {
  std::array<std::uint32_t, 3> ends;
  std::uint32_t slot;
};

/// How boxes are measured in steps and dealt out by blocks of rows.
struct BoxMeasure {
  std::array<float, 3> low{}, steps_per_unit{};       ///< by x, y, z
  std::array<std::size_t, 3> axes{0, 1, 2};           ///< of x, y, z: the rows', the second, the third
  std::vector<std::array<std::uint32_t, 3>> largest;  ///< by level, x, y, z: extents that still belong to it
  std::vector<std::uint32_t> first_block;             ///< by level
  std::vector<std::uint8_t> rows_per_block_log2;      ///< by level

  std::uint32_t low_step(const MeasuredBox& box, std::size_t axis) const {
    return box.ends[axes[axis]] & 0xffff;
  }
  /// Of a box with these extents in steps, x, y, z and one more that is not looked at.
  std::size_t level_of(const std::array<std::uint32_t, 4>& extents) const {
    std::size_t level = 0;
    for (; level + 1 < largest.size(); ++level) {
      if (extents[0] <= largest[level][0] && extents[1] <= largest[level][1] &&
          extents[2] <= largest[level][2])
        break;
    }
    return level;
  }
};

/// Where the results of `measure_boxes` go.
struct MeasuredBoxes {
  MeasuredBox* boxes;                   ///< room for all
  std::uint32_t* blocks;                ///< the same
  std::uint32_t* block_sizes;           ///< are added to
  std::array<std::uint32_t, 3>* reach;  ///< by level, x, y, z: the largest extents seen
};

/// Measures those of the boxes that are not empty; the first has the number `slot`. Returns how many.
std::size_t measure_boxes(const BoxMeasure& measure, std::span<const BoxRows> levels,
                          std::span<const Aabb> boxes, std::uint32_t slot, const MeasuredBoxes& out);

/// Memory of one worker.
struct RowSearch {
  static constexpr std::size_t kBatch = 2048;
  std::array<std::uint32_t, kBatch + 2 * kMaxLanes> first, second;
  PairBins* pairs = nullptr;
  std::uint64_t tests = 0;
};

/// Finds the pairs of boxes [begin, end), which belong to this level, with those behind them there and with
/// all of the levels before. What steps cannot tell is decided by the exact boxes.
void search_rows(const DealtBoxes& boxes, std::size_t level, std::size_t begin, std::size_t end,
                 RowSearch& search);

}  // namespace supple
