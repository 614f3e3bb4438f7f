#include "broad_phase/bulk_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "broad_phase/change_kernel.hpp"

namespace supple {
namespace {

/// Boxes of a block fit into the second-level cache twice.
constexpr std::size_t kBlockSize = 4096;
constexpr std::uint32_t kMostBlocks = 1024;
/// Boxes that come are still in the second-level cache when so many are measured.
constexpr std::size_t kMeasuredAtOnce = 2048;
/// Boxes that an average box shares its cell with; more take longer to search than regions to be made.
constexpr std::uint64_t kMostInCell = 256;
/// With a pair among so many tests branches on whether there are any are mispredicted too often.
constexpr std::uint64_t kTestsPerPair = 48;

std::uint32_t divisions_of(double width, double cell, double most) {
  return static_cast<std::uint32_t>(std::clamp(width / cell, 1.0, most));
}

}  // namespace

bool BulkSearch::find(std::span<const Aabb> boxes, std::span<const BoundingSphere> spheres,
                      const Parallel& parallel, std::size_t last_pair_count, std::span<PairBins> found,
                      const IncomingBoxes& incoming) {
  boxes_.exact = boxes;
  boxes_.spheres = spheres;
  if (!incoming.from.empty() || !deal_by_old_plan(parallel)) {
    planner_.choose(incoming.from.empty() ? boxes : incoming.from, plan_);
    divide();
    measure(incoming, parallel);
    company_ = deal(parallel);
    plan_uses_ = 0;
    planned_count_ = boxes.size();
    planned_reach_ = boxes_.levels.back().reach;
  }
  if (company_ > kMostInCell * box_count()) return false;
  // As it was in the step before; a wrong guess costs little.
  boxes_.is_dense = kTestsPerPair * last_pair_count >= tests();
  workers_.resize(parallel.worker_count());
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    workers_[i].pairs = &found[i];
    workers_[i].tests = 0;
  }
  constexpr std::size_t kGrain = 512;
  parallel.for_ranges(box_count(), kGrain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t level = 0; level < boxes_.levels.size(); ++level) {
      const std::size_t first = std::max<std::size_t>(begin, block_begins_[measure_.first_block[level]]);
      const std::size_t last = std::min<std::size_t>(end, block_begins_[measure_.first_block[level + 1]]);
      if (first < last) search_rows(boxes_, level, first, last, workers_[worker]);
    }
  });
  return true;
}

/// Few boxes have a plan once in some calls: it takes as long as a tenth of the search. False when none
/// suits; it is not trusted when boxes have become many in a cell or larger.
bool BulkSearch::deal_by_old_plan(const Parallel& parallel) {
  constexpr std::size_t kFew = 16384;
  constexpr std::uint32_t kUses = 8;
  const std::size_t count = boxes_.exact.size();
  if (count == 0 || count != planned_count_ || count > kFew || plan_uses_ == kUses) return false;
  ++plan_uses_;
  for (BoxRows& rows : boxes_.levels) rows.reach = {};
  measure({}, parallel);
  for (std::size_t k = 0; k < 3; ++k)
    if (boxes_.levels.back().reach[k] > planned_reach_[k] + planned_reach_[k] / 2) return false;
  return deal(parallel) <= company_ + company_ / 4 + 16;
}

std::uint64_t BulkSearch::tests() const {
  std::uint64_t sum = 0;
  for (const RowSearch& worker : workers_) sum += worker.tests;
  return sum;
}

/// The plan in whole numbers.
void BulkSearch::divide() {
  const auto count = static_cast<double>(boxes_.exact.size());
  measure_.axes = plan_.axes;
  std::array<double, 3> width{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = plan_.low[axis];
    width[axis] = std::max({plan_.high[axis] - low, std::fabs(low) * 0x1p-24, 1e-30});
    measure_.low[axis] = static_cast<float>(low);
    measure_.steps_per_unit[axis] = static_cast<float>(std::min((kSteps - 4) / width[axis], 1e37));
  }
  const std::size_t level_count = plan_.levels.size();
  boxes_.levels.resize(level_count);
  measure_.largest.resize(level_count);
  measure_.first_block.resize(level_count + 1);
  measure_.rows_per_block_log2.resize(level_count);
  std::uint32_t cells = 0, blocks = 0;
  for (std::size_t level = 0; level < level_count; ++level) {
    BoxRows& rows = boxes_.levels[level];
    const auto& [largest, cell] = plan_.levels[level];
    const double most_rows = std::clamp(2 * std::sqrt(count), 1.0, 4096.0);
    for (std::size_t k = 1; k < 3; ++k)
      rows.divisions[k] = divisions_of(width[plan_.axes[k]], cell[plan_.axes[k]], most_rows);
    const double most_cells = std::clamp(2 * count / rows.row_count(), 1.0, kSteps / 2.0);
    rows.divisions[0] = divisions_of(width[plan_.axes[0]], cell[plan_.axes[0]], most_cells);
    rows.first_cell = cells;
    rows.reach = {};
    cells += rows.cell_count();
    for (std::size_t axis = 0; axis < 3; ++axis)
      measure_.largest[level][axis] = static_cast<std::uint32_t>(
          std::clamp(largest[axis] * measure_.steps_per_unit[axis] + 1, 1.0, double{kSteps}));
    measure_.first_block[level] = blocks;
    const double wanted = std::clamp(count / kBlockSize, 1.0, double{kMostBlocks});
    std::uint8_t log2 = 0;
    while ((rows.row_count() >> log2) > wanted) ++log2;
    measure_.rows_per_block_log2[level] = log2;
    blocks += ((rows.row_count() - 1) >> log2) + 1;
  }
  measure_.first_block[level_count] = blocks;
  boxes_.cell_begins.resize(std::size_t{cells} + 2);
}

void BulkSearch::measure(const IncomingBoxes& incoming, const Parallel& parallel) {
  const std::size_t count = boxes_.exact.size();
  measured_.resize(std::max(measured_.size(), count + 1));
  blocks_.resize(count);
  // Some for each worker, so that none waits long for another.
  const std::size_t chunk_count = parallel.worker_count() == 1 ? 1 : 4 * parallel.worker_count();
  chunks_.resize(chunk_count);
  parallel.for_ranges(chunk_count, 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t i = first; i < last; ++i) {
      chunks_[i].begin = count * i / chunk_count;
      chunks_[i].end = count * (i + 1) / chunk_count;
      measure_chunk(incoming, chunks_[i]);
    }
  });
  for (std::size_t level = 0; level < boxes_.levels.size(); ++level)
    for (std::size_t k = 0; k < 3; ++k)
      for (const Chunk& chunk : chunks_)
        boxes_.levels[level].reach[k] =
            std::max(boxes_.levels[level].reach[k], chunk.reach[level][plan_.axes[k]]);
}

void BulkSearch::measure_chunk(const IncomingBoxes& incoming, Chunk& chunk) {
  chunk.block_sizes.assign(measure_.first_block.back(), 0);
  chunk.reach.assign(boxes_.levels.size(), {});
  chunk.measured = chunk.changed = 0;
  for (std::size_t begin = chunk.begin; begin < chunk.end; begin += kMeasuredAtOnce) {
    const std::size_t end = std::min(begin + kMeasuredAtOnce, chunk.end);
    if (!incoming.from.empty())
      chunk.changed += take_over_boxes(incoming.from.data(), incoming.to, begin, end);
    const std::size_t place = chunk.begin + chunk.measured;
    chunk.measured += measure_boxes(
        measure_, boxes_.levels, boxes_.exact.subspan(begin, end - begin), static_cast<std::uint32_t>(begin),
        {measured_.data() + place, blocks_.data() + place, chunk.block_sizes.data(), chunk.reach.data()});
  }
}

std::size_t BulkSearch::changed() const {
  std::size_t sum = 0;
  for (const Chunk& chunk : chunks_) sum += chunk.changed;
  return sum;
}

std::uint64_t BulkSearch::deal(const Parallel& parallel) {
  const std::size_t block_count = measure_.first_block.back();
  block_begins_.resize(block_count + 1);
  std::uint32_t total = 0;
  for (std::size_t block = 0; block < block_count; ++block) {
    block_begins_[block] = total;
    for (Chunk& chunk : chunks_) total += std::exchange(chunk.block_sizes[block], total);
  }
  block_begins_[block_count] = total;
  if (block_count == 1 && chunks_.size() == 1) {
    dealt_.swap(measured_);
  } else {
    dealt_.resize(std::max<std::size_t>(dealt_.size(), total));
    parallel.for_ranges(chunks_.size(), 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
      for (std::size_t i = first; i < last; ++i) deal_chunk(chunks_[i]);
    });
  }
  for (std::vector<std::uint32_t>& ends : boxes_.ends) ends.resize(total + kMaxLanes);
  boxes_.slots.resize(total + kMaxLanes);
  std::atomic<std::uint64_t> squares = 0;
  parallel.for_ranges(block_count, 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t block = first; block < last; ++block) squares += order_block(block);
  });
  boxes_.cell_begins[0] = 0;
  return squares;
}

void BulkSearch::deal_chunk(Chunk& chunk) {
  for (std::size_t i = chunk.begin; i < chunk.begin + chunk.measured; ++i)
    dealt_[chunk.block_sizes[blocks_[i]]++] = measured_[i];
}

std::size_t BulkSearch::level_of(std::size_t block) const {
  std::size_t level = 0;
  while (block >= measure_.first_block[level + 1]) ++level;
  return level;
}

/// Counts the boxes of each cell and puts them there. While they are counted and placed the begin of a cell
/// stands where at last that of the next one does.
std::uint64_t BulkSearch::order_block(std::size_t block) {
  const std::size_t level = level_of(block);
  const BoxRows& rows = boxes_.levels[level];
  const std::uint8_t log2 = measure_.rows_per_block_log2[level];
  const std::uint32_t first_row = static_cast<std::uint32_t>(block - measure_.first_block[level]) << log2;
  const std::uint32_t last_row = std::min(first_row + (1u << log2), rows.row_count());
  std::uint32_t* const next = boxes_.cell_begins.data() + rows.first_cell + 1;
  const bool one_row = rows.row_count() == 1;
  const auto cell_of = [&](const MeasuredBox& box) {
    if (one_row) return rows.division(0, measure_.low_step(box, 0));
    return rows.row_of(measure_.low_step(box, 1), measure_.low_step(box, 2)) * rows.divisions[0] +
           rows.division(0, measure_.low_step(box, 0));
  };
  const std::span<const MeasuredBox> here(dealt_.data() + block_begins_[block],
                                          block_begins_[block + 1] - block_begins_[block]);
  const std::size_t first_cell = std::size_t{first_row} * rows.divisions[0];
  const std::size_t last_cell = std::size_t{last_row} * rows.divisions[0];
  std::fill(next + first_cell, next + last_cell, 0);
  // Where the blocks of the boxes were, which are dealt by now.
  std::uint32_t* const cells = blocks_.data() + block_begins_[block];
  for (std::size_t i = 0; i < here.size(); ++i) ++next[cells[i] = cell_of(here[i])];
  std::uint32_t begin = block_begins_[block];
  std::uint64_t squares = 0;
  for (std::size_t cell = first_cell; cell < last_cell; ++cell) {
    const std::uint64_t count = std::exchange(next[cell], begin);
    begin += static_cast<std::uint32_t>(count);
    squares += count * count;
  }
  const auto& [first, second, third] = measure_.axes;
  for (std::size_t i = 0; i < here.size(); ++i) {
    const MeasuredBox& box = here[i];
    const std::uint32_t place = next[cells[i]]++;
    boxes_.ends[0][place] = box.ends[first];
    boxes_.ends[1][place] = box.ends[second];
    boxes_.ends[2][place] = box.ends[third];
    boxes_.slots[place] = box.slot;
  }
  return squares;
}

}  // namespace supple
