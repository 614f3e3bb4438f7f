#include "broad_phase/grid/grid_search.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace supple {
namespace {

/// When an average box shares its cell with more boxes, the search takes longer than building an octree.
constexpr std::uint64_t crowded_cell = 256;
/// When a pair needs fewer tests on average, most vectors of tested boxes contain a pair.
constexpr std::uint64_t tests_per_pair = 48;

}  // namespace

void GridSearch::search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  bin(volumes, parallel);
  search_cells(parallel, found);
}

bool GridSearch::search_unless_crowded(const VolumeStore& volumes, const Parallel& parallel,
                                       FoundPairs& found) {
  if (bin(volumes, parallel) > crowded_cell * box_count()) return false;
  search_cells(parallel, found);
  return true;
}

/// Returns the sum over all cells of the squares of their counts.
std::uint64_t GridSearch::bin(const VolumeStore& volumes, const Parallel& parallel) {
  const auto boxes = volumes.boxes();
  binned_.exact = boxes;
  binned_.spheres = volumes.spheres();
  planner_.plan(volumes, grid_);
  quantized_.resize(boxes.size());
  blocks_.resize(boxes.size());
  // Several chunks for each worker balance the load.
  const std::size_t chunk_count = parallel.worker_count() == 1 ? 1 : 4 * parallel.worker_count();
  chunks_.resize(chunk_count);
  parallel.for_ranges(chunk_count, 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t i = first; i < last; ++i) {
      chunks_[i].begin = boxes.size() * i / chunk_count;
      chunks_[i].end = boxes.size() * (i + 1) / chunk_count;
      quantize(volumes, chunks_[i]);
    }
  });
  for (std::size_t level = 0; level < grid_.levels.size(); ++level)
    for (const Chunk& chunk : chunks_)
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& max_extent = grid_.levels[level].max_extent[k];
        max_extent = std::max(max_extent, chunk.max_extent[level][grid_.axes[k]]);
      }

  const GridLevel& last_level = grid_.levels.back();
  const std::size_t block_count = last_level.first_block + last_level.block_count();
  block_begins_.resize(block_count + 1);
  std::uint32_t total = 0;
  for (std::size_t block = 0; block < block_count; ++block) {
    block_begins_[block] = total;
    for (Chunk& chunk : chunks_) total += std::exchange(chunk.places[block], total);
  }
  block_begins_[block_count] = total;
  by_block_.resize(boxes.size());
  parallel.for_ranges(chunk_count, 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (Chunk& chunk : std::span(chunks_).subspan(first, last - first))
      for (std::size_t i = chunk.begin; i < chunk.begin + chunk.count; ++i)
        by_block_[chunk.places[blocks_[i]]++] = quantized_[i];
  });
  for (std::vector<std::uint32_t>& ends : binned_.ends) ends.resize(boxes.size() + max_lanes);
  binned_.slots.resize(boxes.size() + max_lanes);
  binned_.cell_begins.resize(std::size_t{last_level.first_cell} + last_level.cell_count() + 2);
  binned_.cell_begins[0] = 0;
  std::atomic<std::uint64_t> squares = 0;
  for (const GridLevel& level : grid_.levels)
    parallel.for_ranges(level.block_count(), 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
      for (std::size_t block = first; block < last; ++block) squares += sort_block(level, block);
    });
  return squares;
}

void GridSearch::quantize(const VolumeStore& volumes, Chunk& chunk) {
  constexpr std::size_t batch_size = 2048;  // stays in the second-level cache
  const GridLevel& last_level = grid_.levels.back();
  chunk.places.assign(last_level.first_block + last_level.block_count(), 0);
  chunk.max_extent.assign(grid_.levels.size(), {});
  chunk.count = 0;
  const bool has_kinds = volumes.wanted().has_kinds();
  const std::size_t level_count = grid_.levels.size();
  const auto level_of_kind = [&](const QuantizedBox& box, std::size_t kind) {
    return grid_.level_of(box, grid_.first_level[kind], grid_.first_level[kind + 1]);
  };
  for (std::size_t begin = chunk.begin; begin < chunk.end; begin += batch_size) {
    const std::size_t place = chunk.begin + chunk.count;
    const auto batch = volumes.boxes().subspan(begin, std::min(batch_size, chunk.end - begin));
    const std::size_t count =
        quantize_boxes(grid_, batch, static_cast<std::uint32_t>(begin), quantized_.data() + place);
    chunk.count += count;
    if (grid_.is_one_row()) continue;
    for (std::size_t i = place; i < place + count; ++i) {
      const QuantizedBox& box = quantized_[i];
      const std::size_t level_index =
          has_kinds ? level_of_kind(box, volumes.kind(box.slot)) : grid_.level_of(box, 0, level_count);
      const GridLevel& level = grid_.levels[level_index];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::uint32_t& max_extent = chunk.max_extent[level_index][axis];
        max_extent = std::max(max_extent, box.extent(axis));
      }
      const std::uint32_t row = level.row_of(box.low(grid_.axes[1]), box.low(grid_.axes[2]));
      ++chunk.places[blocks_[i] = level.first_block + (row >> level.rows_per_block_log2)];
    }
  }
  if (!grid_.is_one_row()) return;
  chunk.places[0] = static_cast<std::uint32_t>(chunk.count);
  std::fill_n(blocks_.begin() + static_cast<std::ptrdiff_t>(chunk.begin), chunk.count, 0);
}

/// Sorts the boxes of a block of rows by cell: counts the boxes of each cell, then places them. Returns the
/// sum of the squared counts. While boxes are placed, `next[cell]` grows from the begin of the cell to its
/// end, which is the begin of the next cell.
std::uint64_t GridSearch::sort_block(const GridLevel& level, std::size_t block_of_level) {
  const auto& [first, second, third] = grid_.axes;
  const std::size_t block = level.first_block + block_of_level;
  const auto rows_per_block = std::size_t{1} << level.rows_per_block_log2;
  const std::size_t first_row = block_of_level * rows_per_block;
  const std::size_t last_row = std::min<std::size_t>(first_row + rows_per_block, level.row_count());
  std::uint32_t* const next = binned_.cell_begins.data() + level.first_cell + 1;
  const bool one_row = level.row_count() == 1;
  std::uint32_t begin = block_begins_[block];
  const std::span<const QuantizedBox> boxes(by_block_.data() + begin, block_begins_[block + 1] - begin);
  const std::span<std::uint32_t> cells(blocks_.data() + begin, boxes.size());
  std::fill(next + first_row * level.divisions[0], next + last_row * level.divisions[0], 0);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    cells[i] = level.division(0, boxes[i].low(first));
    if (!one_row) cells[i] += level.row_of(boxes[i].low(second), boxes[i].low(third)) * level.divisions[0];
    ++next[cells[i]];
  }
  std::uint64_t squares = 0;
  for (std::size_t cell = first_row * level.divisions[0]; cell < last_row * level.divisions[0]; ++cell) {
    const std::uint64_t count = std::exchange(next[cell], begin);
    begin += static_cast<std::uint32_t>(count);
    squares += count * count;
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::uint32_t place = next[cells[i]]++;
    binned_.ends[0][place] = boxes[i].ends[first];
    binned_.ends[1][place] = boxes[i].ends[second];
    binned_.ends[2][place] = boxes[i].ends[third];
    binned_.slots[place] = boxes[i].slot;
  }
  return squares;
}

void GridSearch::search_cells(const Parallel& parallel, FoundPairs& found) {
  const auto lists = sorter_.start(parallel.worker_count(), binned_.exact.size());
  std::atomic<std::uint64_t> tests = 0;
  constexpr std::size_t grain = 512;
  parallel.for_ranges(box_count(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = 0; i < grid_.levels.size(); ++i) {
      const GridLevel& level = grid_.levels[i];
      const std::size_t first = std::max<std::size_t>(begin, block_begins_[level.first_block]);
      const std::size_t last =
          std::min<std::size_t>(end, block_begins_[level.first_block + level.block_count()]);
      if (first < last) tests += supple::search_cells(grid_, binned_, i, first, last, lists[worker]);
    }
  });
  sorter_.finish(parallel, found.pairs);
  found.stats.method = BroadPhaseMethod::grid;
  found.stats.object_pairs_tested = tests;
  found.stats.objects_paired = box_count();
  // The next step is likely similar. A wrong guess costs little time.
  binned_.has_many_pairs = tests_per_pair * found.pairs.size() >= tests;
}

}  // namespace supple
