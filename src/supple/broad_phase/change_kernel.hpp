#pragma once

#include <cstddef>
#include <cstdint>

#include "supple/types.hpp"

namespace supple {

/// Writes the numbers of boxes [begin, end) that differ bit by bit between two arrays to `out`, ascending,
/// which has room for all; of two that are both empty none. Returns how many there are.
std::size_t list_changed_boxes(const Aabb* now, const Aabb* before, std::size_t begin, std::size_t end,
                               std::uint32_t* out);

/// Copies boxes [begin, end) over those that were there before; returns how many differed, in the same sense.
std::size_t take_over_boxes(const Aabb* now, Aabb* before, std::size_t begin, std::size_t end);

}  // namespace supple
