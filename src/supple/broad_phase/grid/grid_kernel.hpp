#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/broad_phase.hpp"
#include "supple/types.hpp"

namespace supple {

class PairList;

/// The number of steps along each axis to which coordinates are quantized.
inline constexpr std::uint32_t quantization_steps = 1u << 16;

/// A box in whole steps, from 1 to 65,534. For each of x, y, z, the lower half of a word is the step of the
/// lower end, and the upper half is 65,535 minus the step of the upper end.
struct QuantizedBox {
  std::array<std::uint32_t, 3> ends;
  std::uint32_t slot;

  std::uint32_t low(std::size_t axis) const { return ends[axis] & 0xffff; }
  std::uint32_t extent(std::size_t axis) const { return 0xffff - (ends[axis] >> 16) - (ends[axis] & 0xffff); }
};

/// One level of the hierarchical grid: boxes of one kind and similar size. Its cells form rows along the
/// first axis. Rows are in order of the third axis, then the second. A box is in the cell of its lower
/// corner.
struct GridLevel {
  std::array<std::uint32_t, 3> divisions{1, 1, 1};  ///< cells of a row, rows along the second and third axis
  std::array<std::uint32_t, 3> max_extent{};        ///< the largest of its boxes, in steps, by grid axis
  std::array<std::uint32_t, 3> limit{};             ///< the largest allowed, in steps, by x, y, z
  std::uint32_t first_cell = 0;
  std::uint32_t first_block = 0;  ///< a block is 2^rows_per_block_log2 rows, which are sorted together
  std::uint8_t rows_per_block_log2 = 0;
  std::uint8_t kind = 0;
  /// A bit for each level, perhaps this one, whose boxes are tested against those of this level.
  std::uint32_t tested_levels = 0;

  std::uint32_t division(std::size_t axis, std::uint32_t step) const {
    return step * divisions[axis] / quantization_steps;
  }
  std::uint32_t row_of(std::uint32_t second, std::uint32_t third) const {
    return division(2, third) * divisions[1] + division(1, second);
  }
  std::uint32_t row_count() const { return divisions[1] * divisions[2]; }
  std::uint32_t cell_count() const { return divisions[0] * row_count(); }
  std::uint32_t block_count() const { return ((row_count() - 1) >> rows_per_block_log2) + 1; }
};

struct Grid {
  std::array<float, 3> low{}, steps_per_unit{};  ///< by x, y, z
  std::array<std::size_t, 3> axes{0, 1, 2};      ///< the first, second and third axis: 0 is x, 1 is y, 2 is z
  std::vector<GridLevel> levels;                 ///< by kind, then from the smallest boxes to the largest
  std::array<std::uint32_t, volume_kind_count + 1> first_level{};  ///< of each kind, and the number of levels

  bool is_one_row() const { return levels.size() == 1 && levels[0].row_count() == 1; }
  /// The first of the levels [begin, end) whose limit is at least the box's extent. The last one has no
  /// limit.
  std::size_t level_of(const QuantizedBox& box, std::size_t begin, std::size_t end) const {
    std::size_t level = begin;
    for (; level + 1 < end; ++level) {
      const auto& limit = levels[level].limit;
      if (box.extent(0) <= limit[0] && box.extent(1) <= limit[1] && box.extent(2) <= limit[2]) break;
    }
    return level;
  }
};

/// All boxes, sorted by level, row and cell.
struct BinnedBoxes {
  std::array<std::vector<std::uint32_t>, 3> ends;  ///< as in `QuantizedBox`, by grid axis
  std::vector<std::uint32_t> slots;
  std::vector<std::uint32_t> cell_begins;     ///< one more than cells
  bool has_many_pairs = false;                ///< most vectors of tested boxes contain a pair
  std::span<const Aabb> exact;                ///< per slot
  std::span<const BoundingSphere> spheres{};  ///< per slot, or empty; if given, spheres decide which overlap
};

/// Quantizes the boxes that are not empty to `out`, which has room for all boxes, and returns their number.
/// The first of all boxes has the slot `slot`.
std::size_t quantize_boxes(const Grid& grid, std::span<const Aabb> boxes, std::uint32_t slot,
                           QuantizedBox* out);

/// Finds the pairs of the boxes [begin, end), which belong to this level, with the boxes that follow them in
/// the level, if these are paired, and with all boxes of its other levels. The exact boxes decide pairs whose
/// ends are in the same step. Returns the number of tests.
std::uint64_t search_cells(const Grid& grid, const BinnedBoxes& boxes, std::size_t level, std::size_t begin,
                           std::size_t end, PairList& pairs);

}  // namespace supple
