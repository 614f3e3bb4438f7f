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

/// What the error of a distance and its normal is at most: 4 units in the last place, or 2^-26 of it, for
/// which integers are rarely needed.
enum class DistanceAccuracy : std::uint8_t { full, rough };

/// The functions of `supple/distance.hpp` as one. `max_distance` ≥ 0. Sets `used_exact` when integers decide.
/// Decisions and features are exact for any accuracy.
std::optional<ElementDistance> distance_within(const ElementPoints& elements, double max_distance,
                                               bool& used_exact,
                                               DistanceAccuracy accuracy = DistanceAccuracy::full);

/// The sign of the difference of two distances: -1 when the first is smaller. Exact. Sets `used_exact` when
/// integers decide.
int compare_distances(const ElementPoints& p, const ElementPoints& q, bool& used_exact);

}  // namespace supple
