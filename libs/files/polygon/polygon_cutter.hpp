#pragma once

#include <cstdint>
#include <span>

#include "files/polygon/ear_clipper.hpp"
#include "files/polygon/outline_view.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// What is special about the outline of a polygon.
struct PolygonShape {
  bool concave = false;  ///< it turns both ways; false when it crosses itself
  bool crosses = false;  ///< some points are not once inside or outside: it winds around them another way
  bool bent = false;     ///< a corner is farther from the mean plane than 1/1000 of the polygon's size
};

/// Cuts polygons into triangles. It keeps its memory from one polygon to the next.
///
/// The outline is seen along the axis in which its area is the largest. In this view all verdicts are exact.
/// A polygon whose fan around the first corner stays inside becomes this fan: convex polygons always do.
/// Other polygons are cut by ears. So the triangles cover the inside of the outline once, also when corners
/// lie on one line, when corners or edges coincide, and when edges touch. They may have no area where the
/// polygon has none.
///
/// The sum of the triangles, each with the sign of its turn, is always the winding number of the outline. An
/// outline that crosses itself gets n - 2 triangles, too; some overlap or turn the other way. A polygon with
/// a coordinate that is not finite, or with all corners on one line, becomes the fan of its first corner.
///
/// A convex polygon takes O(n) time, others O(n log n) in practice.
class PolygonCutter {
 public:
  /// Writes corners.size() - 2 triangles of corner numbers, which keep the direction of the outline. There
  /// must be at least three corners.
  PolygonShape cut(std::span<const Vec3d> corners, std::span<Triangle> triangles);

 private:
  EarClipper clipper_;
};

}  // namespace supple
