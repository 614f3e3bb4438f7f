#pragma once

#include "mesh/polygon/outline_view.hpp"

namespace supple {

/// Whether the outline crosses itself: two edges cross, or it winds around some area neither once nor not at
/// all. Edges and corners that touch or coincide do not cross. Exact; O(n log n) for n corners.
bool crosses_itself(const OutlineView& view);

}  // namespace supple
