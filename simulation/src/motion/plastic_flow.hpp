#pragma once

#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/network/spring_network.hpp"

namespace supple {

/// Plastic flow: where strain exceeds `yield_strain`, the rest length relaxes for `seconds` towards the
/// length at which the strain equals `yield_strain`. The relaxation is implicit, so any step is stable.
/// Returns true when a rest length changed.
bool flow(std::span<SpringElement> springs, double yield_strain, double rate, double seconds,
          std::span<const Vec3d> positions, const Parallel& parallel);

/// For each area element, its edges from corner 0 to 1, 1 to 2 and 2 to 0, as indices into `edges`.
std::vector<Triangle> sides_of_areas(std::span<const AreaElement> areas,
                                     std::span<const SpringElement> edges);

/// Sets each rest area to that of a triangle with the rest lengths of its edges, or to 0 when no such
/// triangle exists.
void follow_rest_lengths(std::span<AreaElement> areas, std::span<const Triangle> sides,
                         std::span<const SpringElement> edges);

}  // namespace supple
