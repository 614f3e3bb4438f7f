#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "supple/distance.hpp"

namespace supple {

/// The vertices of element a, then those of element b. Element a has one vertex and b one to three, or both
/// have two.
struct ElementPoints {
  std::array<Vec3d, 4> points{};
  std::uint8_t count_a = 1, count_b = 1;
};

/// The functions of `supple/distance.hpp` as one. `max_distance` ≥ 0. Sets `used_exact` when integers decide.
std::optional<ElementDistance> distance_within(const ElementPoints& elements, double max_distance,
                                               bool& used_exact);

}  // namespace supple
