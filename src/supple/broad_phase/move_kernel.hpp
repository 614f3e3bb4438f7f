#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "broad_phase/box_cells.hpp"

namespace supple {

/// Boxes that moved, each slot once, and where they are now. With spheres, where there are some, these are
/// the boxes around them, and they decide which pairs overlap.
struct BoxMoves {
  std::span<const std::uint32_t> slots;
  std::span<const Aabb> boxes;
  std::span<const BoundingSphere> spheres;
};

/// Moves boxes in the cells and in `boxes` (and `spheres`), which are all of them by slot, one after the
/// other. Adds each pair that begins or ends to overlap to `toggled`, as a << 32 | b, and as often as it
/// does: a pair of which both moved perhaps twice. Returns false when it stopped before the end: the cells
/// had no room left, or `tests`, which boxes tested are taken from, were used up.
bool move_boxes(BoxCells& cells, const BoxMoves& moves, std::span<Aabb> boxes,
                std::span<BoundingSphere> spheres, std::int64_t& tests, std::vector<std::uint64_t>& toggled);

}  // namespace supple
