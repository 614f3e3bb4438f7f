#pragma once

#include <span>

#include "files/polygon/outline_view.hpp"
#include "files/polygon/outline_winding.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Cuts a polygon into triangles by its ears: corners whose triangle with both neighbours lies inside the
/// outline. Writes view.size() - 2 triangles of corner numbers, which keep the direction of the outline.
/// `winding` is that of `find_winding`. Returns false when a triangle turns to the right.
///
/// An ear is cut only where the outline winds once around its triangle. So when every corner can be cut, the
/// triangles cover the inside once. Where an outline that does not cross itself comes back to a place, its
/// edges there get new links, so that each corner has a part of the inside to itself. Then the outline is
/// several loops, and corners at one place do not hinder each other. When no ear is left, as in an outline
/// that crosses itself, corners are cut whose triangle turns left, and then any. Outlines that cross
/// themselves can have many corners in many triangles, so their corners are no longer tested after 100 tests
/// a corner.
bool clip_ears(const OutlineView& view, const OutlineWinding& winding, std::span<Triangle> triangles);

}  // namespace supple
