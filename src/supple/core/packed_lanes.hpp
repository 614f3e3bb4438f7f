#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace supple {

/// For each bit mask of eight lanes: the numbers of its lanes in ascending order, followed by zeros.
inline constexpr std::array<std::array<std::uint8_t, 8>, 256> packed_lane_tables = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (std::size_t set = 0; set < table.size(); ++set) {
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < 8; ++lane)
      if ((set >> lane & 1) != 0) table[set][count++] = static_cast<std::uint8_t>(lane);
  }
  return table;
}();

}  // namespace supple
