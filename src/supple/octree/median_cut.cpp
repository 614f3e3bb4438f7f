#include "octree/median_cut.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace supple {
namespace {

/// A gap is much wider than usual when it is so many times the distance of points on average.
constexpr std::uint64_t wide_gap = 4;
/// And is looked for within this part of all from the target.
constexpr std::uint32_t gap_reach = 16;

std::uint32_t distance(std::uint32_t p, std::uint32_t q) {
  return p < q ? q - p : p - q;
}

}  // namespace

CutBox empty_cut_box() {
  constexpr float inf = std::numeric_limits<float>::infinity();
  return {{inf, inf, inf}, {-inf, -inf, -inf}};
}

void extend(CutBox& box, const CutBox& other) {
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(box.low[axis], other.low[axis]);
    box.high[axis] = std::max(box.high[axis], other.high[axis]);
  }
}

CutBox box_of(std::span<const CutPoint> points) {
  // The number comes along as a fourth coordinate: so four are compared at a time.
  constexpr float inf = std::numeric_limits<float>::infinity();
  std::array<float, 4> low{inf, inf, inf, inf}, high{-inf, -inf, -inf, -inf};
  for (const CutPoint& point : points) {
    const auto at = std::bit_cast<std::array<float, 4>>(point);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      low[lane] = at[lane] < low[lane] ? at[lane] : low[lane];
      high[lane] = at[lane] > high[lane] ? at[lane] : high[lane];
    }
  }
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

int CutBox::longest_axis() const {
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis) longest = extent(axis) > extent(longest) ? axis : longest;
  return longest;
}

double CutBox::surface() const {
  const double x = extent(0), y = extent(1), z = extent(2);
  return x * y + y * z + z * x;
}

std::size_t MedianCut::cut(std::span<CutPoint> points, int axis, const CutBox& box, const CutGoal& goal) {
  const std::uint32_t cell_count = points.size() < 256 ? 64 : points.size() < 2048 ? 256 : 1024;
  Cells cells{box.low[axis], box.high[axis], 0, cell_count};
  for (bool all_within = true;; all_within = false) {
    cells.scale = static_cast<float>(cells.count - 2) / (cells.high - cells.low);
    // Equal, or so near that floats have no reciprocal for it.
    if (!(cells.scale < std::numeric_limits<float>::infinity())) return cut_equal(points, axis, cells, goal);
    weigh(points, axis, cells, all_within);
    const std::uint32_t best = best_cell(goal);
    if (best != 0) return cut_before(points, axis, cells, best);
    // The target is within a cell that weighs too much: look into it.
    std::uint32_t target_cell = 0;
    for (std::uint32_t before = 0; before + cell_weights_[target_cell] < goal.target; ++target_cell) {
      before += cell_weights_[target_cell];
    }
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const CutPoint& point : points) {
      if (cells(point.at[axis]) != target_cell) continue;
      low = std::min(low, point.at[axis]);
      high = std::max(high, point.at[axis]);
    }
    cells.low = low;
    cells.high = high;
  }
}

void MedianCut::weigh(std::span<const CutPoint> points, int axis, const Cells& cells, bool all_within) {
  cell_weights_.assign(cells.count, 0);
  std::uint32_t* const cell_weights = cell_weights_.data();
  if (all_within && weights_.empty()) {
    for (const CutPoint& point : points) ++cell_weights[cells.within(point.at[axis])];
  } else {
    for (const CutPoint& point : points) cell_weights[cells(point.at[axis])] += weight(point);
  }
}

/// The first cell of the upper side; 0 when a look at smaller cells may find something better.
std::uint32_t MedianCut::best_cell(const CutGoal& goal) const {
  std::uint32_t all = 0;
  for (const std::uint32_t w : cell_weights_) all += w;
  const auto cell_count = static_cast<std::uint32_t>(cell_weights_.size());
  const std::uint32_t reach = all / gap_reach;
  std::uint32_t before = 0, empty = 0, best = 0, best_gap = 0, nearest = 0;
  std::uint32_t nearest_distance = std::numeric_limits<std::uint32_t>::max();
  for (std::uint32_t cell = 0; cell < cell_count; ++cell) {
    if (cell_weights_[cell] == 0) {
      ++empty;
      continue;
    }
    if (before >= goal.least && before <= goal.most) {
      const std::uint32_t away = distance(before, goal.target);
      const bool is_wide = std::uint64_t{empty} * all > wide_gap * cell_count;
      if (is_wide && away <= reach && empty > best_gap) {
        best = cell;
        best_gap = empty;
      }
      if (away < nearest_distance) {
        nearest = cell;
        nearest_distance = away;
      }
    }
    before += cell_weights_[cell];
    empty = 0;
  }
  if (best != 0) return best;
  return nearest_distance <= reach ? nearest : 0;
}

/// Those in the cells before `cell` come first.
std::size_t MedianCut::cut_before(std::span<CutPoint> points, int axis, const Cells& cells,
                                  std::uint32_t cell) {
  if (cell == cells.count - 1) {
    return partition(points, [&](const CutPoint& point) { return point.at[axis] > cells.high; });
  }
  // A number is rounded down to a whole one or more exactly when it is so much itself.
  const float low = cells.low, scale = cells.scale, least = static_cast<float>(cell - 1);
  return partition(points, [=](const CutPoint& point) { return (point.at[axis] - low) * scale >= least; });
}

template <class IsUpper>
std::size_t MedianCut::partition(std::span<CutPoint> points, IsUpper is_upper) {
  if (upper_.size() < points.size()) upper_.resize(points.size());
  // Both are written and one counts, without a branch that would be guessed wrong half of the time.
  CutPoint* lower = points.data();
  CutPoint* upper = upper_.data();
  for (const CutPoint& point : points) {
    const CutPoint copy = point;
    const std::ptrdiff_t goes_up = is_upper(copy) ? 1 : 0;
    *lower = copy;
    *upper = copy;
    lower += 1 - goes_up;
    upper += goes_up;
  }
  std::copy(upper_.data(), upper, lower);
  return static_cast<std::size_t>(lower - points.data());
}

/// Before those in the cells, behind them, or in their midst when neither is within the limits.
std::size_t MedianCut::cut_equal(std::span<CutPoint> points, int axis, const Cells& cells,
                                 const CutGoal& goal) {
  std::uint32_t less = 0, equal = 0;
  for (const CutPoint& point : points) {
    if (point.at[axis] > cells.high) continue;
    (point.at[axis] < cells.low ? less : equal) += weight(point);
  }
  const auto is_allowed = [&](std::uint32_t before) { return before >= goal.least && before <= goal.most; };
  std::uint32_t room = 0;
  if (is_allowed(less) || is_allowed(less + equal)) {
    const bool takes_equal =
        !is_allowed(less) ||
        (is_allowed(less + equal) && distance(less + equal, goal.target) < distance(less, goal.target));
    room = takes_equal ? equal : 0;
  } else {
    room = goal.target - less;
  }
  return partition(points, [&](const CutPoint& point) {
    if (point.at[axis] < cells.low) return false;
    if (point.at[axis] > cells.high) return true;
    const std::uint32_t own = weight(point);
    const bool goes_up = 2 * std::uint64_t{room} < own;
    room -= std::min(room, own);
    return goes_up;
  });
}

}  // namespace supple
