#pragma once

#include <optional>

#include "supple/continuous.hpp"

namespace supple {

/// When two elements first touch, their separation being 0, decided by integers: exact for all finite
/// coordinates, whatever coincides, collapses or stays in one plane. Nothing when they do not touch within
/// the step or a coordinate is not finite. What `first_impact` asks where floating point cannot tell.
///
/// Takes 1 to 10 µs while the coordinates of an axis span at most 124 bits, from the largest number to the
/// last bit of the most precise one. Wider spans, and polynomials with a double root where the elements come
/// near, take integers of any length: mostly below 100 µs, but milliseconds where some coordinates are 2^1000
/// times as large as others.
std::optional<TimeBracket> exact_first_contact(const VertexFaceMotion& motion);
std::optional<TimeBracket> exact_first_contact(const EdgeEdgeMotion& motion);

}  // namespace supple
