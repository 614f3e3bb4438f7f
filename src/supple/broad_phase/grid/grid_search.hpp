#pragma once

#include <cstdint>
#include <vector>

#include "broad_phase/grid/grid_kernel.hpp"
#include "broad_phase/grid/grid_plan.hpp"
#include "broad_phase/pair_search.hpp"
#include "broad_phase/pair_sorter.hpp"

namespace supple {

/// A hierarchical grid, rebuilt in each step. The boxes are quantized and sorted by kind, size, row and cell.
/// Each box is tested against the boxes that follow it in its row and in the rows beside it, up to 16 at a
/// time, and against the boxes of all levels for smaller boxes, as far as the kinds are paired. Each box is
/// in one cell, so each pair is found once.
class GridSearch final : public PairSearch {
 public:
  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;
  /// Returns false without a search when so many boxes share cells that an octree is faster.
  bool search_unless_crowded(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found);

 private:
  /// A range of boxes that one worker quantizes.
  struct Chunk {
    std::size_t begin = 0, end = 0, count = 0;  // `count` boxes of the range are not empty
    std::vector<std::uint32_t> places;  // by block: its number of boxes in the range, then their place
    std::vector<std::array<std::uint32_t, 3>> max_extent;  // by level and by x, y, z
  };

  std::uint64_t bin(const VolumeStore& volumes, const Parallel& parallel);
  void quantize(const VolumeStore& volumes, Chunk& chunk);
  std::uint64_t sort_block(const GridLevel& level, std::size_t block);
  void search_cells(const Parallel& parallel, FoundPairs& found);
  std::size_t box_count() const { return block_begins_.back(); }

  GridPlanner planner_;
  Grid grid_;
  std::vector<Chunk> chunks_;
  std::vector<QuantizedBox> quantized_, by_block_;
  std::vector<std::uint32_t> blocks_;        // per quantized box
  std::vector<std::uint32_t> block_begins_;  // one more than blocks
  BinnedBoxes binned_;
  PairSorter sorter_;
};

}  // namespace supple
