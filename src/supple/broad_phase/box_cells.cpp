#include "broad_phase/box_cells.hpp"

namespace supple {

void BoxCells::fill(const BoxMeasure& measure, const DealtBoxes& dealt) {
  // A hole for so many boxes, and for so many cells without any.
  constexpr std::uint32_t kBoxesPerHole = 8, kCellsPerHole = 32;
  measure_ = measure;
  levels_.assign(dealt.levels.begin(), dealt.levels.end());
  const std::size_t cell_count = levels_.back().first_cell + levels_.back().cell_count();
  const std::size_t box_count = dealt.cell_begins[cell_count];
  boxes_.resize(box_count + box_count / kBoxesPerHole + cell_count / kCellsPerHole + 1 + kPadding);
  begins_.resize(cell_count + 2);
  const auto& [first, second, third] = measure.axes;
  std::size_t place = 0;
  std::uint32_t due = 0;  // of a hole, in parts
  for (std::size_t cell = 0; cell < cell_count; ++cell) {
    begins_[cell] = static_cast<std::uint32_t>(place);
    const std::uint32_t begin = dealt.cell_begins[cell], end = dealt.cell_begins[cell + 1];
    for (std::size_t i = begin; i < end; ++i) {
      MeasuredBox& box = boxes_[place++];
      box.ends[first] = dealt.ends[0][i];
      box.ends[second] = dealt.ends[1][i];
      box.ends[third] = dealt.ends[2][i];
      box.slot = dealt.slots[i];
    }
    due += 1 + (end - begin) * (kCellsPerHole / kBoxesPerHole);
    for (; due >= kCellsPerHole; due -= kCellsPerHole) boxes_[place++] = kHole;
  }
  begins_[cell_count] = static_cast<std::uint32_t>(place);
  std::fill(boxes_.begin() + static_cast<std::ptrdiff_t>(place), boxes_.end(), kHole);
  begins_[cell_count + 1] = static_cast<std::uint32_t>(boxes_.size() - kPadding);
}

std::string BoxCells::validate(std::span<const Aabb> boxes) const {
  std::vector<std::uint8_t> seen(boxes.size(), 0);
  const std::string name = "box cells: slot ";
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const BoxRows& rows = levels_[level];
    for (std::uint32_t cell = rows.first_cell; cell < rows.first_cell + rows.cell_count(); ++cell) {
      if (begins_[cell] > begins_[cell + 1]) return "box cells: they begin out of order";
      for (std::size_t place = begins_[cell]; place < begins_[cell + 1]; ++place) {
        const MeasuredBox& box = boxes_[place];
        if (box.slot == kNoBox) continue;
        if (box.slot >= boxes.size() || boxes[box.slot].empty() || seen[box.slot]++ != 0)
          return name + std::to_string(box.slot) + " is there twice or is empty";
        if (cell_of(level, box) != cell) return name + std::to_string(box.slot) + " is in a wrong cell";
        std::array<std::uint32_t, 4> extents{};
        for (std::size_t axis = 0; axis < 3; ++axis)
          extents[axis] = 0xffff - (box.ends[axis] >> 16) - (box.ends[axis] & 0xffff);
        if (measure_.level_of(extents) != level)
          return name + std::to_string(box.slot) + " is in a wrong level";
        for (std::size_t k = 0; k < 3; ++k)
          if (extents[measure_.axes[k]] > rows.reach[k])
            return name + std::to_string(box.slot) + " is longer than its level's reach";
      }
    }
  }
  for (std::size_t slot = 0; slot < boxes.size(); ++slot)
    if ((seen[slot] != 0) == boxes[slot].empty()) return name + std::to_string(slot) + " is missing";
  return {};
}

}  // namespace supple
