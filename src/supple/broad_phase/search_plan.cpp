#include "broad_phase/search_plan.hpp"

#include <algorithm>
#include <cmath>

namespace supple {
namespace {

/// Coordinates are taken to be no farther out: beyond, differences and products would overflow.
constexpr float kFarthest = 1e37f;
constexpr std::size_t kMostLevels = 4;

/// Nanoseconds, about, by profiles on a 2.5 GHz Xeon with vectors of 16 lanes; only their ratios matter.
constexpr double kRowCost = 6;     // one more row that a box is held against
constexpr double kVectorCost = 3;  // 16 boxes that it is held against
constexpr double kLanes = 16;
/// Up to so many vectors in one row dividing costs more than it saves: 16 were slower.
constexpr double kFewVectors = 8;

}  // namespace

void SearchPlanner::choose(std::span<const Aabb> boxes, SearchPlan& plan) {
  sample(boxes);
  bound(plan);
  measure_extents();
  choose_axes(plan);
  plan.levels.clear();
  if (suits_one_row(plan)) {
    add_row(plan);
    return;
  }
  measure_sizes();
  choose_levels(plan);
  add_row(plan);
}

/// Every k-th box, without those that are empty or have no finite centre.
void SearchPlanner::sample(std::span<const Aabb> boxes) {
  const std::size_t wanted = std::min<std::size_t>(64 + boxes.size() / 64, 1024);
  const std::size_t stride = boxes.size() / wanted + 1;
  sampled_.clear();
  for (std::size_t i = stride / 2; i < boxes.size(); i += stride) {
    const Aabb& box = boxes[i];
    if (box.empty()) continue;
    Sampled one{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      one.low[axis] = std::clamp(box.min[static_cast<int>(axis)], -kFarthest, kFarthest);
      one.high[axis] = std::clamp(box.max[static_cast<int>(axis)], -kFarthest, kFarthest);
    }
    sampled_.push_back(one);
  }
  count_ = boxes.size();
}

/// All of the sample, but for boxes far outside of where the others are.
void SearchPlanner::bound(SearchPlan& plan) {
  constexpr double margin = 0.125;
  const std::size_t outermost = sampled_.size() / 32;
  for (std::size_t axis = 0; axis < 3 && !sampled_.empty(); ++axis) {
    const auto ranked = [&](std::size_t rank) {
      const auto place = scratch_.begin() + static_cast<std::ptrdiff_t>(rank);
      std::nth_element(scratch_.begin(), place, scratch_.end());
      return *place;
    };
    scratch_.clear();
    for (const Sampled& one : sampled_) scratch_.push_back(one.low[axis]);
    const double low = ranked(outermost), lowest = *std::min_element(scratch_.begin(), scratch_.end());
    scratch_.clear();
    for (const Sampled& one : sampled_) scratch_.push_back(one.high[axis]);
    const double high = ranked(scratch_.size() - 1 - outermost),
                 highest = *std::max_element(scratch_.begin(), scratch_.end());
    const double room = margin * (high - low);
    plan.low[axis] = std::max(low - room, lowest);
    plan.high[axis] = std::min(high + room, highest);
  }
}

void SearchPlanner::measure_extents() {
  double largest_mean = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (const Sampled& one : sampled_) sum += double{one.high[axis]} - one.low[axis];
    mean_extent_[axis] = sampled_.empty() ? 1 : sum / static_cast<double>(sampled_.size());
    largest_mean = std::max(largest_mean, mean_extent_[axis]);
  }
  for (double& mean : mean_extent_) mean = std::max({mean, 1e-3 * largest_mean, 1e-30});
}

/// The sweep is along the axis on which boxes are spread widest, in mean extents.
void SearchPlanner::choose_axes(SearchPlan& plan) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    width_[axis] = std::max(plan.high[axis] - plan.low[axis], mean_extent_[axis]) / mean_extent_[axis];
  std::sort(plan.axes.begin(), plan.axes.end(), [&](std::size_t a, std::size_t b) {
    return width_[a] != width_[b] ? width_[a] > width_[b] : a < b;
  });
}

/// When a box meets few vectors of others along the sweep, dividing costs more than it saves.
bool SearchPlanner::suits_one_row(const SearchPlan& plan) const {
  return static_cast<double>(count_) / width_[plan.axes[0]] < kFewVectors * kLanes;
}

/// One row for all that is left.
void SearchPlanner::add_row(SearchPlan& plan) {
  SearchPlan::Level row;
  for (std::size_t axis = 0; axis < 3; ++axis)
    row.cell[axis] = 2 * (plan.high[axis] - plan.low[axis]) + 1e-30;
  const bool is_alone = plan.levels.empty();
  row.cell[plan.axes[0]] /= is_alone ? static_cast<double>(count_) + 1 : 128;
  plan.levels.push_back(row);
}

void SearchPlanner::measure_sizes() {
  for (Sampled& one : sampled_) {
    one.size = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      one.size = std::max(one.size, (double{one.high[axis]} - one.low[axis]) / mean_extent_[axis]);
  }
  std::sort(sampled_.begin(), sampled_.end(),
            [](const Sampled& a, const Sampled& b) { return a.size < b.size; });
}

/// How many times as many boxes lie around a box as if they were spread evenly.
double SearchPlanner::crowding(const SearchPlan& plan) {
  constexpr std::uint32_t side = 8;
  cells_.assign(side * side * side, 0);
  for (const Sampled& one : sampled_) {
    std::uint32_t cell = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double width = plan.high[axis] - plan.low[axis];
      const double place = width > 0 ? (one.low[axis] - plan.low[axis]) / width * side : 0;
      cell = cell * side + static_cast<std::uint32_t>(std::clamp(place, 0.0, side - 1.0));
    }
    ++cells_[cell];
  }
  double company = 0;
  for (const double in_cell : cells_) company += in_cell * (in_cell - 1);
  const auto all = static_cast<double>(sampled_.size());
  return std::max(1.0, company * static_cast<double>(cells_.size()) / std::max(all * all, 1.0));
}

/// Boxes up to a size go into a level, those above it into the next, and so on. A level costs what its boxes
/// take among themselves, and what larger ones take with them; that is estimated for some sizes and widths of
/// rows, in mean extents, and the best taken.
void SearchPlanner::choose_levels(SearchPlan& plan) {
  const std::array<double, 3>& width = width_;
  const double crowd = crowding(plan);
  const double per_sampled =
      static_cast<double>(count_) / static_cast<double>(std::max<std::size_t>(sampled_.size(), 1));
  std::size_t begin = 0;
  do {
    const std::size_t left = sampled_.size() - begin;
    double best_cost = 1e300, best_size = 1, best_row = 2;
    std::size_t best_end = sampled_.size();
    double size_sum = 0;
    std::size_t summed = begin;
    for (const double share : {0.5, 0.75, 0.875, 0.9375, 0.97, 1.0}) {
      const bool is_last = share == 1.0 || left < 16 || plan.levels.size() + 1 == kMostLevels;
      std::size_t end =
          is_last ? sampled_.size() : begin + static_cast<std::size_t>(share * static_cast<double>(left));
      if (end == begin) end = sampled_.size();
      if (end == begin) break;
      const double size = sampled_[end - 1].size;
      while (end < sampled_.size() && sampled_[end].size <= size * 1.01) ++end;
      for (; summed < end; ++summed) size_sum += sampled_[summed].size;
      const auto here = static_cast<double>(end - begin);
      const double mean = size_sum / here;
      const double density = crowd * here * per_sampled / (width[0] * width[1] * width[2]);
      for (const double ratio : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0}) {
        const double row = ratio * std::max(size, 1e-3);
        const double above = mean / row, below = size / row;
        const auto in_row = [&](double length) { return density * row * row * length; };
        const auto cost_of = [&](double rows, double length) {
          return rows * (kRowCost + kVectorCost * (1 + in_row(length) / kLanes));
        };
        double cost = here * cost_of(1 + above + above * (1 + above + below), mean + size);
        for (std::size_t i = end; i < sampled_.size(); ++i) {
          const double rows = 1 + (sampled_[i].size + size) / row;
          cost += cost_of(rows * rows, sampled_[i].size + size);
        }
        // What the larger ones will take among themselves, about.
        cost += static_cast<double>(sampled_.size() - end) * cost_of(3, 2 * size);
        if (cost < best_cost) {
          best_cost = cost;
          best_size = size;
          best_row = row;
          best_end = end;
        }
      }
      if (end == sampled_.size()) break;
    }
    SearchPlan::Level level;
    const auto here = static_cast<double>(best_end - begin) * per_sampled;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t axis = plan.axes[k];
      level.largest[axis] = 1.02 * best_size * mean_extent_[axis];
      level.cell[axis] = best_row * mean_extent_[axis];
    }
    // Cells along rows: a part of the boxes, and about one for each of them.
    const std::size_t first = plan.axes[0];
    const double rows =
        std::max(1.0, width[plan.axes[1]] / best_row) * std::max(1.0, width[plan.axes[2]] / best_row);
    level.cell[first] =
        mean_extent_[first] * std::max(best_size / 4, width[first] * rows / std::max(here, 1.0));
    plan.levels.push_back(level);
    begin = best_end;
  } while (begin < sampled_.size());
}

}  // namespace supple
