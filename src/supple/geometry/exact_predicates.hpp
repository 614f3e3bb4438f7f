#pragma once

#include "geometry/plane_filter.hpp"
#include "supple/types.hpp"

namespace supple {

// Signs of determinants, exact for all finite coordinates. Floating point decides when an error bound proves
// the sign. Otherwise integers decide, and `used_exact` becomes true. It never becomes false.

/// Sign of (b - a) × (c - a) · (d - a): 1 when d lies on the side of the plane from which a, b, c go
/// counter-clockwise, 0 when the four points lie in one plane.
int orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d, bool& used_exact);

/// The same, for repeated use of `plane`, the plane of a, b, c.
int orient3d(const FilteredPlane& plane, const Vec3d& b, const Vec3d& c, const Vec3d& d, bool& used_exact);

/// Sign of the component along `axis` of (b - a) × (c - a): the turn of a, b, c seen along that axis.
int orient2d(const Vec3d& a, const Vec3d& b, const Vec3d& c, int axis, bool& used_exact);

/// A view along an axis in which three points turn left (1) or right (-1).
struct Projection {
  int axis = -1;  ///< -1: the points lie on one line in space
  int turn = 0;

  explicit operator bool() const { return axis >= 0; }
};
Projection find_projection(const Vec3d& a, const Vec3d& b, const Vec3d& c, bool& used_exact);

/// By x, then y, then z; along a line this is the order of its points.
inline bool lexicographically_less(const Vec3d& a, const Vec3d& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

}  // namespace supple
