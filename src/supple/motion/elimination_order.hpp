#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace supple {

/// Rows 0 … count - 1 of a symmetric matrix in an order in which elimination fills little, by approximate
/// minimum degree: result[i] is the row eliminated as the i-th. `entries` are off the diagonal, each pair
/// once, in any order.
std::vector<std::uint32_t> elimination_order(std::uint32_t count,
                                             std::span<const std::array<std::uint32_t, 2>> entries);

}  // namespace supple
