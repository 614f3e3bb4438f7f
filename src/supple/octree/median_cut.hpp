#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace supple {

/// A point that is to be told apart from others: of something with that number, of some weight.
struct alignas(16) CutPoint {
  float at[3];
  std::uint32_t id;
};

/// Box of points; inverted when there are none.
struct CutBox {
  float low[3], high[3];

  float extent(int axis) const { return high[axis] - low[axis]; }
  /// 0, 1 or 2; the first of equal ones.
  int longest_axis() const;
  /// Half of it.
  double surface() const;
};
CutBox empty_cut_box();
void extend(CutBox& box, const CutBox& other);
CutBox box_of(std::span<const CutPoint> points);

/// How much may come before a cut, by weight: `target` at best. All are at least 1, and less than all.
struct CutGoal {
  std::uint32_t target, least, most;
};

/// Cuts sets of points in two across an axis.
///
/// A cut is made near the target where the points leave a gap much wider than usual, if there is one: so rows
/// of a grid and things that lie apart stay whole. Otherwise it is the cut between different coordinates that
/// comes nearest to the target; and if equal ones weigh so much that there is none within the limits, these
/// are cut in the order in which they come. Comparisons and roundings are the same everywhere.
class MedianCut {
 public:
  /// `weights` is empty where all points weigh 1, or has the weight of each number.
  explicit MedianCut(std::span<const std::uint32_t> weights = {}) : weights_(weights) {}

  /// Puts those of the lower side first, both sides in the order in which they were; returns how many these
  /// are: at least one of two or more, and not all, if none weighs more than the target or than the rest.
  /// O(n).
  std::size_t cut(std::span<CutPoint> points, int axis, const CutBox& box, const CutGoal& goal);

 private:
  /// The coordinates from `low` to `high` in cells of one size, from 1 to `count` - 2; those before and those
  /// behind them have a cell each.
  struct Cells {
    float low, high, scale;
    std::uint32_t count;

    /// Of a coordinate from `low` to `high`.
    std::uint32_t within(float coordinate) const {
      const float cell = (coordinate - low) * scale, last = static_cast<float>(count - 3);
      return 1 + static_cast<std::uint32_t>(cell < last ? cell : last);
    }
    std::uint32_t operator()(float coordinate) const {
      return coordinate < low ? 0 : coordinate > high ? count - 1 : within(coordinate);
    }
  };

  std::uint32_t weight(const CutPoint& point) const { return weights_.empty() ? 1 : weights_[point.id]; }
  void weigh(std::span<const CutPoint> points, int axis, const Cells& cells, bool all_within);
  std::uint32_t best_cell(const CutGoal& goal) const;
  std::size_t cut_before(std::span<CutPoint> points, int axis, const Cells& cells, std::uint32_t cell);
  std::size_t cut_equal(std::span<CutPoint> points, int axis, const Cells& cells, const CutGoal& goal);
  template <class IsUpper>
  std::size_t partition(std::span<CutPoint> points, IsUpper is_upper);

  std::span<const std::uint32_t> weights_;
  std::vector<std::uint32_t> cell_weights_;
  std::vector<CutPoint> upper_;
};

}  // namespace supple
