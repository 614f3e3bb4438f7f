#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broad_phase/box_lanes.hpp"

namespace supple {

/// Tests each box of rows [begin, end) against all boxes behind it and appends the overlapping pairs that
/// begin here. Returns the number of tests, which is the same for every instruction set.
std::uint64_t find_overlaps(const BoxLanes& boxes, std::size_t begin, std::size_t end, PairBuffer& pairs);

/// The same for boxes sorted by ascending lower end along axis 0: a row ends where the boxes begin behind it.
std::uint64_t find_overlaps_sorted(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                                   PairBuffer& pairs);

/// Replaces `found` by those of the slots whose boxes overlap this one.
void find_overlaps_of(const Aabb& box, std::span<const Aabb> boxes, std::span<const std::uint32_t> slots,
                      std::vector<std::uint32_t>& found);

}  // namespace supple
