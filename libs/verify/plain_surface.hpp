#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"
#include "verify/algebra/distance_algebra.hpp"
#include "verify/brute_force_elements.hpp"

// The surface of one object, for `verify`. Intervals of doubles decide what they can, and integers the rest.
// Shares no code with detection and queries.
namespace supple {

/// 1 on the side of the plane from which the corners go counter-clockwise.
int side_of_plane(const TrianglePoints& t, const Vec3d& p);
/// The squared distance of a point and a triangle with finite coordinates, exactly.
Rational squared_distance_by_integers(const Vec3d& point, const TrianglePoints& corners);

/// More than a distance that was computed in double precision, whose squares may underflow.
inline double increased(double distance) {
  return distance * (1 + 0x1p-40) + 0x1p-500;
}

/// A triangle with finite corners, and its exact box.
struct BoxedCorners {
  TrianglePoints corners;
  QueryBox box;
  std::uint32_t triangle = 0;  ///< the user's number
};

/// The triangles of one object.
struct PlainSurface {
  bool has_inert = false;               ///< triangles with a corner that is not finite are left out
  std::vector<BoxedCorners> triangles;  ///< the others, ascending
  PlainTree tree{{}};

  explicit PlainSurface(const PlainObject& object);

  /// Where a finite point is: on a triangle, else inside by an odd number of crossings of a ray along x. With
  /// a triangle that is left out, nothing is inside.
  Containment containment(const Vec3d& point) const;

  struct Nearest {
    std::uint32_t triangle = 0;  ///< the user's number; the smallest of several
    Rational squared;
    std::size_t place = 0;  ///< in `triangles`
  };
  /// The nearest triangle of a finite point. There must be one. The search starts at the place `guess`.
  Nearest nearest(const Vec3d& point, std::size_t guess = 0) const;
  /// At least the distance of a finite point, or `bound` if that is less.
  double bound_of_distance(const Vec3d& point, double bound) const;
};

}  // namespace supple
