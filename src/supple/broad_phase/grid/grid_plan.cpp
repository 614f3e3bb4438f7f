#include "broad_phase/grid/grid_plan.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace supple {
namespace {

/// Coordinates are clamped to this range, so that differences and products stay finite.
constexpr float farthest = 1e37f;
constexpr std::size_t most_levels = 4;
/// One row is the fastest grid while a box meets fewer others along it.
constexpr double others_of_one_row = 128;
/// Otherwise rows are so narrow that a box meets about this number of others in each row.
constexpr double others_of_row = 16;

}  // namespace

void GridPlanner::plan(const VolumeStore& volumes, Grid& grid) {
  count_ = static_cast<double>(volumes.slot_count());
  take_sample(volumes);
  choose_bounds(grid);
  choose_axes(grid);
  measure_sizes();
  grid.levels.clear();
  auto begin = samples_.begin();
  for (std::size_t kind = 0; kind < volume_kind_count; ++kind) {
    grid.first_level[kind] = static_cast<std::uint32_t>(grid.levels.size());
    if (volumes.wanted().partners(kind) == 0) continue;
    const auto end =
        std::find_if(begin, samples_.end(), [&](const Sample& sample) { return sample.kind != kind; });
    choose_levels(kind, std::span(begin, end), grid);
    begin = end;
  }
  grid.first_level.back() = static_cast<std::uint32_t>(grid.levels.size());
  pair_levels(volumes.wanted(), grid.levels);
}

/// Takes every k-th box, without empty ones.
void GridPlanner::take_sample(const VolumeStore& volumes) {
  const auto boxes = volumes.boxes();
  const std::size_t wanted = std::min<std::size_t>(64 + boxes.size() / 64, 1024);
  const std::size_t stride = boxes.size() / wanted + 1;
  samples_.clear();
  for (std::size_t i = stride / 2; i < boxes.size(); i += stride) {
    if (boxes[i].empty()) continue;
    Sample sample{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sample.low[axis] = std::clamp(boxes[i].min[static_cast<int>(axis)], -farthest, farthest);
      sample.high[axis] = std::clamp(boxes[i].max[static_cast<int>(axis)], -farthest, farthest);
    }
    sample.kind = volumes.kind(static_cast<std::uint32_t>(i));
    samples_.push_back(sample);
  }
}

/// The bounds are those of the sample, without boxes that are far from all others.
void GridPlanner::choose_bounds(Grid& grid) {
  constexpr double margin = 0.125;  // beyond the inner 15/16 of the sample
  const std::size_t outermost = samples_.size() / 32;
  for (std::size_t axis = 0; axis < 3 && !samples_.empty(); ++axis) {
    const auto ranked = [&](auto member, std::size_t rank) {
      scratch_.clear();
      for (const Sample& sample : samples_) scratch_.push_back((sample.*member)[axis]);
      const auto place = scratch_.begin() + static_cast<std::ptrdiff_t>(rank);
      std::nth_element(scratch_.begin(), place, scratch_.end());
      return *place;
    };
    const double low = ranked(&Sample::low, outermost);
    const double lowest = *std::min_element(scratch_.begin(), scratch_.end());
    const double high = ranked(&Sample::high, samples_.size() - 1 - outermost);
    const double highest = *std::max_element(scratch_.begin(), scratch_.end());
    low_[axis] = std::max(low - margin * (high - low), lowest);
    high_[axis] = std::min(high + margin * (high - low), highest);
    const double width = std::max({high_[axis] - low_[axis], std::fabs(low_[axis]) * 0x1p-24, 1e-30});
    grid.low[axis] = static_cast<float>(low_[axis]);
    grid.steps_per_unit[axis] = static_cast<float>(std::min((quantization_steps - 4) / width, 1e37));
  }
}

/// Rows lie along the axis with the largest width, measured in mean extents.
void GridPlanner::choose_axes(Grid& grid) {
  double largest_mean = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (const Sample& sample : samples_) sum += double{sample.high[axis]} - sample.low[axis];
    mean_extent_[axis] = samples_.empty() ? 1 : sum / static_cast<double>(samples_.size());
    largest_mean = std::max(largest_mean, mean_extent_[axis]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double& mean = mean_extent_[axis];
    mean = std::max({mean, 1e-3 * largest_mean, 1e-30});
    width_in_extents_[axis] = std::max(high_[axis] - low_[axis], mean) / mean;
  }
  const auto widest = std::max_element(width_in_extents_.begin(), width_in_extents_.end());
  const auto first = static_cast<std::size_t>(widest - width_in_extents_.begin());
  grid.axes = {first, (first + 1) % 3, (first + 2) % 3};
}

/// Sorts the sample by kind and size.
void GridPlanner::measure_sizes() {
  for (Sample& sample : samples_) {
    sample.size = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      sample.size =
          std::max(sample.size, (double{sample.high[axis]} - sample.low[axis]) / mean_extent_[axis]);
  }
  std::sort(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
    return std::tie(a.kind, a.size) < std::tie(b.kind, b.size);
  });
}

/// Adds the levels of one kind of boxes, from the sample of this kind. The first level takes the smallest
/// 31/32 of the boxes, and somewhat larger ones. The next level takes the same share of the boxes that are
/// left, and so on. The last level has one row and takes all boxes that are left.
///
/// Boxes that are much smaller than their level's limit are tested against boxes that they would not meet in
/// narrower rows. But at least 1/32 of the level's boxes are half as large as the limit or larger, and
/// overlap what surrounds them. With 16 tests at a time, the tests in vain take about as long as these pairs.
void GridPlanner::choose_levels(std::size_t kind, std::span<const Sample> samples, Grid& grid) const {
  const double boxes_of_sample = count_ / static_cast<double>(std::max<std::size_t>(samples_.size(), 1));
  const auto count_of = [&](std::size_t sample_count) {
    return boxes_of_sample * static_cast<double>(sample_count);
  };
  const bool is_dense = count_of(samples.size()) / width_in_extents_[grid.axes[0]] >= others_of_one_row;
  std::size_t added = 0;
  for (auto rest = samples; is_dense && !rest.empty() && added + 1 < most_levels; ++added) {
    const double largest = rest[rest.size() * 31 / 32].size;
    const auto end = std::upper_bound(rest.begin(), rest.end(), 2 * largest,
                                      [](double size, const Sample& sample) { return size < sample.size; });
    const auto count = static_cast<std::size_t>(end - rest.begin());
    add_level(grid, kind, count_of(count), std::max(rest[count - 1].size, 1e-3));
    rest = rest.subspan(count);
  }
  add_level(grid, kind, added == 0 && !samples.empty() ? count_of(samples.size()) / 2 : 256, 0);
  grid.levels.back().limit.fill(quantization_steps);
}

/// Two levels whose kinds are paired: the boxes of the level with larger boxes are tested against the other.
void GridPlanner::pair_levels(const WantedKinds& wanted, std::vector<GridLevel>& levels) {
  static_assert(most_levels * volume_kind_count <= 32, "a word has a bit for each level");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      if (!wanted.are_paired(levels[i].kind, levels[j].kind)) continue;
      const bool has_smaller = levels[i].limit[0] < levels[j].limit[0];
      levels[has_smaller ? j : i].tested_levels |= 1u << (has_smaller ? i : j);
    }
  }
}

/// Adds a level for `count` boxes up to a size in mean extents; for boxes of any size when it is 0.
void GridPlanner::add_level(Grid& grid, std::size_t kind, double count, double size) const {
  constexpr double boxes_of_block = 4096, most_blocks = 1024;  // two blocks fit into the second-level cache
  GridLevel level;
  level.kind = static_cast<std::uint8_t>(kind);
  const auto width = [&](std::size_t k) { return width_in_extents_[grid.axes[k]]; };
  const double others = count * 2 * size / width(0);
  if (others >= others_of_one_row) {
    const double row_width = std::max(std::sqrt(width(1) * width(2) * others_of_row / others), 0.5 * size);
    for (const std::size_t k : {1, 2})
      level.divisions[k] = static_cast<std::uint32_t>(std::clamp(width(k) / row_width, 1.0, 4096.0));
  }
  // One cell for each box, but no cells much shorter than the boxes.
  const double cells = std::clamp(count / level.row_count(), 1.0, quantization_steps / 2.0);
  const double useful_cells = size > 0 ? 4 * width(0) / size : cells;
  level.divisions[0] = static_cast<std::uint32_t>(std::clamp(useful_cells, 1.0, cells));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double limit = 1.02 * size * mean_extent_[axis] * grid.steps_per_unit[axis] + 1;
    level.limit[axis] = static_cast<std::uint32_t>(std::clamp(limit, 1.0, double{quantization_steps}));
  }
  const double blocks = std::clamp(count / boxes_of_block, 1.0, most_blocks);
  while ((level.row_count() >> level.rows_per_block_log2) > blocks) ++level.rows_per_block_log2;
  if (!grid.levels.empty()) {
    const GridLevel& before = grid.levels.back();
    level.first_cell = before.first_cell + before.cell_count();
    level.first_block = before.first_block + before.block_count();
  }
  grid.levels.push_back(level);
}

}  // namespace supple
