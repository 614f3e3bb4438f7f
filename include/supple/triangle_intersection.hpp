#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "supple/contact.hpp"
#include "supple/types.hpp"

namespace supple {

/// The corners of a closed triangle, in the user's order. They may coincide or lie on one line: the triangle
/// is then the point or the segment that they span.
using TrianglePoints = std::array<Vec3d, 3>;

/// What two closed triangles share, by its extreme points.
struct TriangleIntersection {
  bool intersects = false;
  /// True when floating-point filters could not decide and integers did.
  bool used_exact_fallback = false;
  IntersectionKind kind = IntersectionKind::point;  ///< meaningful when `intersects`
  std::uint8_t point_count = 0;                     ///< 0 to 6
  std::array<ContactPoint, 6> points;               ///< the first `point_count`

  std::span<const ContactPoint> extreme_points() const { return {points.data(), point_count}; }
};

/// Whether two closed triangles have a point in common, as exact arithmetic decides on the given coordinates,
/// whatever finite numbers they are. A triangle with a coordinate that is not finite touches nothing.
///
/// Symmetric, and independent of the order of the corners. Takes 20 to 40 ns for triangles that the plane of
/// one of them separates, about 100 ns for others, more where only integers can tell: some microseconds when
/// coordinates differ by more than 2^100 in size. Allocates memory only in that last case.
bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b);

/// The same decision, and the extreme points of what the triangles share, each with the feature of a and the
/// feature of b whose relative interiors meet there. Nothing is left out and nothing is named twice.
///
/// A corner that another corner of the same triangle repeats is named by the smaller index; of collinear
/// corners, the segment is the edge between the two outer ones.
///
/// One point for a point, two for a segment, three to six for a polygon (of coplanar triangles). A point or a
/// segment is listed in ascending order of (on_a, on_b); a polygon goes round in convex order, starting from
/// the smallest (on_a, on_b) towards the smaller of its two neighbours.
///
/// Takes about 100 ns more than the decision for each point that is not a vertex.
///
/// Positions: a vertex is given bit for bit (that of a where both are vertices). Any other point lies on an
/// edge; it is off the exact one by at most 2^-44 of the edge's extent along each axis plus half a unit in
/// the last place, and never outside the box of either triangle. It depends on that edge and the opposite
/// edge or face alone, not on the order of corners or triangles, so triangles that share an edge report the
/// same bits there.
TriangleIntersection intersect_triangles(const TrianglePoints& a, const TrianglePoints& b);

/// The same decision as `triangles_intersect`, by integers of unlimited size and separating axes: unrelated
/// code without any floating-point arithmetic, for checking. Takes 2 to 12 microseconds for coordinates of
/// ordinary size.
bool triangles_intersect_by_axes(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
