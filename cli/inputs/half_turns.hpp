#pragma once

#include <span>

#include "supple/types.hpp"

namespace supple::cli {

/// Whether a body turns by more than 120 degrees about any axis from one frame to the next. The straight
/// paths of its vertices then shrink it to less than half of its width meanwhile, so that continuous
/// contacts are not those of its motion. The turn is that of the rigid motion that fits best; when the body
/// moves in another way, the answer is false. Vertices that are not finite do not count. O(n).
bool turns_too_far(std::span<const Vec3d> from, std::span<const Vec3d> to);

}  // namespace supple::cli
