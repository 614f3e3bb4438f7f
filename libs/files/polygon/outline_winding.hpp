#pragma once

#include <vector>

#include "files/polygon/outline_view.hpp"

namespace supple {

struct OutlineWinding {
  /// Two edges cross, or the outline winds around some area neither once nor not at all. Edges and corners
  /// that touch or coincide do not cross.
  bool crosses = false;
  /// Whether the area directly below each corner is inside, for an outline that does not cross itself. Below
  /// is to the right of the direction of `OutlineView::before`.
  std::vector<bool> is_inside_below{};
};

/// Exact; O(n log n) for n corners.
OutlineWinding find_winding(const OutlineView& view);

}  // namespace supple
