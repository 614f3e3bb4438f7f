#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "broad_phase/row_kernel.hpp"

namespace supple {

/// The boxes of `DealtBoxes`, each in the cell of its lower corner, with room between them: one that moves is
/// taken out and put in elsewhere, and the others stay where they are but for a few. Rows, levels and steps
/// are those that were chosen when all were dealt out, and suit the boxes the less the more of them moved.
class BoxCells {
 public:
  /// The slot of a place where no box is. Its ends are past every bound.
  static constexpr std::uint32_t kNoBox = 0xffffffff;
  static constexpr MeasuredBox kHole{{0xffffffff, 0xffffffff, 0xffffffff}, kNoBox};
  /// Boxes are readable so far past the last.
  static constexpr std::size_t kPadding = kMaxLanes / 4;

  /// O(boxes + cells).
  void fill(const BoxMeasure& measure, const DealtBoxes& dealt);

  const BoxMeasure& measure() const { return measure_; }
  std::span<const BoxRows> levels() const { return levels_; }
  /// Per cell of all levels, and one more.
  const std::uint32_t* begins() const { return begins_.data(); }
  const MeasuredBox* boxes() const { return boxes_.data(); }

  std::uint32_t cell_of(std::size_t level, const MeasuredBox& box) const {
    const BoxRows& rows = levels_[level];
    const std::uint32_t row = rows.row_of(measure_.low_step(box, 1), measure_.low_step(box, 2));
    return rows.first_cell + row * rows.divisions[0] + rows.division(0, measure_.low_step(box, 0));
  }

  /// Of the box that is in this cell under this slot. Returns its place.
  std::size_t take_out(std::uint32_t cell, std::uint32_t slot) {
    std::size_t place = begins_[cell];
    while (boxes_[place].slot != slot) ++place;
    boxes_[place] = kHole;
    return place;
  }
  /// Where one of the same cell was taken out last.
  void put_back(std::size_t place, const MeasuredBox& box) { boxes_[place] = box; }
  /// False when there is no room anywhere near; all are then to be dealt out again.
  bool put_in(std::uint32_t cell, const MeasuredBox& box);
  /// The level is to have a box of these extents.
  void reach_to(std::size_t level, const std::array<std::uint32_t, 4>& extents) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& reach = levels_[level].reach[k];
      if (extents[measure_.axes[k]] <= reach) continue;
      reach = extents[measure_.axes[k]];
      ++reach_version_;
    }
  }
  /// Differs when the reach of any level does.
  std::uint64_t reach_version() const { return reach_version_; }

  /// Empty, or what is wrong: exactly the boxes that are not empty are to be in their cells.
  std::string validate(std::span<const Aabb> boxes) const;

 private:
  BoxMeasure measure_;
  std::vector<BoxRows> levels_;
  std::vector<std::uint32_t> begins_;  // and of one more cell behind the last, in which there are only holes
  std::vector<MeasuredBox> boxes_;
  std::uint64_t reach_version_ = 0;
};

/// The next hole is passed on from cell to cell: each gives its first place to the one before it.
inline bool BoxCells::put_in(std::uint32_t cell, const MeasuredBox& box) {
  constexpr std::size_t kLongestWay = 2048;  // places and cells
  std::size_t place = begins_[cell], cell_count = begins_.size() - 1;
  std::uint32_t owner = cell;
  for (std::size_t way = 0;; ++way) {
    if (way == kLongestWay || owner == cell_count) return false;
    if (place == begins_[owner + 1]) {
      ++owner;
    } else if (boxes_[place].slot == kNoBox) {
      break;
    } else {
      ++place;
    }
  }
  for (; owner != cell; --owner) {
    boxes_[place] = boxes_[begins_[owner]];
    place = begins_[owner]++;
  }
  boxes_[place] = box;
  return true;
}

}  // namespace supple
