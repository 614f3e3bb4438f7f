#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/exact_predicates.hpp"
#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple {

/// A polygon seen along an axis in which it winds counter-clockwise. All verdicts are exact for finite
/// coordinates.
class OutlineView {
 public:
  /// Looks along the axis in which the area of the outline is largest, up to rounding.
  explicit OutlineView(std::span<const Vec3d> corners);

  /// False when all corners lie on one line in space.
  explicit operator bool() const { return static_cast<bool>(projection_); }
  std::size_t size() const { return corners_.size(); }
  const Vec3d& operator[](std::uint32_t corner) const { return corners_[corner]; }

  /// 1 when `point` is left of the line from a to b, -1 when it is right, 0 on the line.
  int side(const Vec3d& a, const Vec3d& b, const Vec3d& point) const {
    bool used_exact = false;
    return projection_.turn * orient2d(a, b, point, projection_.axis, used_exact);
  }
  int side(std::uint32_t a, std::uint32_t b, std::uint32_t point) const {
    return side(corners_[a], corners_[b], corners_[point]);
  }
  int x_axis() const { return (projection_.axis + 1) % 3; }
  int y_axis() const { return (projection_.axis + 2) % 3; }
  double x(std::uint32_t corner) const { return corners_[corner][x_axis()]; }
  double y(std::uint32_t corner) const { return corners_[corner][y_axis()]; }
  /// 1 when the axes x, y of the view turn counter-clockwise, too; otherwise -1.
  int turn() const { return projection_.turn; }

  bool same_place(std::uint32_t a, std::uint32_t b) const { return x(a) == x(b) && y(a) == y(b); }
  /// By x, then by y.
  bool before(std::uint32_t a, std::uint32_t b) const { return x(a) != x(b) ? x(a) < x(b) : y(a) < y(b); }

 private:
  std::span<const Vec3d> corners_;
  Projection projection_;
};

/// Whether a corner is farther from the mean plane of the corners than 1/1000 of the largest extent along an
/// axis. Computed with rounding.
bool is_bent(std::span<const Vec3d> corners);

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
