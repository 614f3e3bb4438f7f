#pragma once

#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/spring_network.hpp"

namespace supple {

/// Rest lengths follow where strain is beyond `yield_strain`: for `seconds`, by implicit relaxation towards
/// the length at which the strain would be just that, so that no step is too long. True when any changed.
bool flow(std::span<SpringElement> springs, double yield_strain, double rate, double seconds,
          std::span<const Vec3d> positions, const Parallel& parallel);

/// The three edges of each area: those from corner 0 to 1, 1 to 2 and 2 to 0, as places in `edges`.
std::vector<Triangle> sides_of_areas(std::span<const AreaElement> areas,
                                     std::span<const SpringElement> edges);

/// Rest areas become those of triangles whose sides have the rest lengths of the edges; 0 where there is no
/// such triangle.
void follow_rest_lengths(std::span<AreaElement> areas, std::span<const Triangle> sides,
                         std::span<const SpringElement> edges);

}  // namespace supple
