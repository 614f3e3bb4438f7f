#pragma once

#include <optional>

#include "supple/continuous.hpp"

namespace supple {

/// When two elements first touch, their separation being 0, decided by integers: exact for all finite
/// coordinates. What `first_impact` asks where floating point cannot tell.
std::optional<TimeBracket> exact_first_contact(const VertexFaceMotion& motion);
std::optional<TimeBracket> exact_first_contact(const EdgeEdgeMotion& motion);

}  // namespace supple
