#include "broad_phase/grid/grid_plan.hpp"

#include <algorithm>
#include <cmath>

namespace supple {
namespace {

/// Coordinates beyond are taken to be here: differences and products stay finite.
constexpr float farthest = 1e37f;
constexpr std::size_t most_levels = 4;

/// Nanoseconds, about, measured on a 2.5 GHz Xeon with vectors of 16 lanes; only their ratios matter.
constexpr double row_cost = 6;     // one more row to search
constexpr double vector_cost = 3;  // one test of 16 boxes
constexpr double lanes = 16;
/// Up to so many vectors in one row, further rows cost more than they save.
constexpr double few_vectors = 8;

}  // namespace

void GridPlanner::plan(std::span<const Aabb> boxes, Grid& grid) {
  count_ = boxes.size();
  take_sample(boxes);
  choose_bounds(grid);
  choose_axes(grid);
  grid.levels.clear();
  const std::size_t first = grid.axes[0];
  const auto count = static_cast<double>(count_);
  const bool is_sparse = count / width_in_extents_[first] < few_vectors * lanes;
  if (!is_sparse) choose_levels(grid);
  // One row for all boxes that are left.
  Lengths cell;
  for (std::size_t axis = 0; axis < 3; ++axis) cell[axis] = 2 * (high_[axis] - low_[axis]) + 1e-30;
  cell[first] /= is_sparse ? count + 1 : 128;
  add_level(grid, {}, cell);
}

/// Every k-th box, without empty ones.
void GridPlanner::take_sample(std::span<const Aabb> boxes) {
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
    samples_.push_back(sample);
  }
}

/// Around all of the sample, but for boxes far outside of the others.
void GridPlanner::choose_bounds(Grid& grid) {
  constexpr double margin = 0.125;
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

/// Rows are along the axis on which the boxes are spread widest, in mean extents.
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
  grid.axes = {0, 1, 2};
  // Not std::stable_sort, which allocates memory.
  std::sort(grid.axes.begin(), grid.axes.end(), [&](std::size_t a, std::size_t b) {
    if (width_in_extents_[a] != width_in_extents_[b]) return width_in_extents_[a] > width_in_extents_[b];
    return a < b;
  });
}

/// How many times as many boxes are around a box as if they were spread evenly.
double GridPlanner::density_of_clusters() const {
  constexpr std::uint32_t side = 8;
  std::array<std::uint32_t, side * side * side> counts{};
  for (const Sample& sample : samples_) {
    std::uint32_t cell = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double width = high_[axis] - low_[axis];
      const double place = width > 0 ? (sample.low[axis] - low_[axis]) / width * side : 0;
      cell = cell * side + static_cast<std::uint32_t>(std::clamp(place, 0.0, side - 1.0));
    }
    ++counts[cell];
  }
  double neighbours = 0;
  for (const double count : counts) neighbours += count * (count - 1);
  const auto all = static_cast<double>(samples_.size());
  return std::max(1.0, neighbours * static_cast<double>(counts.size()) / std::max(all * all, 1.0));
}

/// Boxes up to a size go into a level, larger ones into the next, and so on. The cost of a level is that of
/// the pairs of its own boxes and of its boxes with larger ones. It is estimated for some sizes and widths of
/// rows, in mean extents, and the best is taken.
void GridPlanner::choose_levels(Grid& grid) {
  for (Sample& sample : samples_) {
    sample.size = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      sample.size =
          std::max(sample.size, (double{sample.high[axis]} - sample.low[axis]) / mean_extent_[axis]);
  }
  std::sort(samples_.begin(), samples_.end(),
            [](const Sample& a, const Sample& b) { return a.size < b.size; });
  const Lengths& width = width_in_extents_;
  const double clusters = density_of_clusters();
  const double per_sample = static_cast<double>(count_) / std::max(static_cast<double>(samples_.size()), 1.0);
  for (std::size_t begin = 0, best_end = 0; begin < samples_.size(); begin = best_end) {
    const std::size_t left = samples_.size() - begin;
    double best_cost = 1e300, best_size = 1, best_row = 2, size_sum = 0;
    std::size_t summed = begin;
    best_end = samples_.size();
    for (const double share : {0.5, 0.75, 0.875, 0.9375, 0.97, 1.0}) {
      const bool takes_all = share == 1.0 || left < 16 || grid.levels.size() + 1 == most_levels;
      std::size_t end = samples_.size();
      if (!takes_all) end = begin + static_cast<std::size_t>(share * static_cast<double>(left));
      const double size = samples_[end - 1].size;
      while (end < samples_.size() && samples_[end].size <= size * 1.01) ++end;
      for (; summed < end; ++summed) size_sum += samples_[summed].size;
      const auto count = static_cast<double>(end - begin);
      const double mean = size_sum / count;
      const double density = clusters * count * per_sample / (width[0] * width[1] * width[2]);
      for (const double ratio : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0}) {
        const double row = ratio * std::max(size, 1e-3);
        const double above = mean / row, below = size / row;
        const auto cost_of = [&](double rows, double length) {
          return rows * (row_cost + vector_cost * (1 + density * row * row * length / lanes));
        };
        double cost = count * cost_of(1 + above + above * (1 + above + below), mean + size);
        for (std::size_t i = end; i < samples_.size(); ++i) {
          const double rows = 1 + (samples_[i].size + size) / row;
          cost += cost_of(rows * rows, samples_[i].size + size);
        }
        // The pairs of larger boxes with one another, about.
        cost += static_cast<double>(samples_.size() - end) * cost_of(3, 2 * size);
        if (cost < best_cost) {
          best_cost = cost;
          best_size = size;
          best_row = row;
          best_end = end;
        }
      }
      if (end == samples_.size()) break;
    }
    Lengths limit, cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      limit[axis] = 1.02 * best_size * mean_extent_[axis];
      cell[axis] = best_row * mean_extent_[axis];
    }
    // Cells along rows: a part of the boxes, and about one for each of them.
    const std::size_t first = grid.axes[0];
    const double rows =
        std::max(1.0, width[grid.axes[1]] / best_row) * std::max(1.0, width[grid.axes[2]] / best_row);
    const double count = static_cast<double>(best_end - begin) * per_sample;
    cell[first] = mean_extent_[first] * std::max(best_size / 4, width[first] * rows / std::max(count, 1.0));
    add_level(grid, limit, cell);
  }
}

/// Divides space for boxes up to a size. At most about as many cells as boxes are made.
void GridPlanner::add_level(Grid& grid, const Lengths& limit, const Lengths& cell) const {
  constexpr double boxes_of_block = 4096, most_blocks = 1024;  // two blocks fit into the second-level cache
  const auto count = static_cast<double>(count_);
  GridLevel level;
  const auto divide = [&](std::size_t k, double most) {
    const std::size_t axis = grid.axes[k];
    const double width = (quantization_steps - 4) / double{grid.steps_per_unit[axis]};
    level.divisions[k] = static_cast<std::uint32_t>(std::clamp(width / cell[axis], 1.0, most));
  };
  for (const std::size_t k : {1, 2}) divide(k, std::clamp(2 * std::sqrt(count), 1.0, 4096.0));
  divide(0, std::clamp(2 * count / level.row_count(), 1.0, quantization_steps / 2.0));
  for (std::size_t axis = 0; axis < 3; ++axis)
    level.limit[axis] = static_cast<std::uint32_t>(
        std::clamp(limit[axis] * grid.steps_per_unit[axis] + 1, 1.0, double{quantization_steps}));
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
