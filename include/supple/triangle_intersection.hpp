#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "supple/contact.hpp"
#include "supple/types.hpp"

namespace supple {

/// The corners of a closed triangle, in the user's order. When they coincide or lie on one line, the triangle
/// is the point or the segment that they span.
using TrianglePoints = std::array<Vec3d, 3>;

/// The unit normal by the right-hand rule; zero when the triangle has no area or a corner is not finite.
/// Rounded.
Vec3d unit_normal(const TrianglePoints& triangle);
/// The area, rounded; not finite when a corner is not finite.
double area(const TrianglePoints& triangle);

/// What two closed triangles share: the extreme points of their intersection.
struct TriangleIntersection {
  bool intersects = false;
  /// True when integers decided because floating-point filters could not.
  bool used_exact_fallback = false;
  IntersectionKind kind = IntersectionKind::point;  ///< meaningful when `intersects`
  std::uint8_t point_count = 0;                     ///< 0 to 6
  std::array<ContactPoint, 6> points;               ///< the first `point_count` are valid
  /// Unit vector from b to a; zero when the triangles are apart. See `intersect_triangles`.
  Vec3d normal{};

  std::span<const ContactPoint> extreme_points() const { return {points.data(), point_count}; }
};

/// Whether two closed triangles have a point in common, as exact arithmetic decides on the given coordinates.
/// All finite coordinates are allowed. A triangle with a coordinate that is not finite touches nothing.
///
/// The result is symmetric, and independent of the order of the corners. Takes 20 to 40 ns for triangles that
/// the plane of one of them separates, about 100 ns for others, and more when only integers can decide: a few
/// microseconds when coordinates differ by more than 2^100 in size. Allocates memory only in that last case.
bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b);

/// Makes the same decision and finds the extreme points of what the triangles share. Each point has the
/// feature of a and the feature of b whose relative interiors meet there. The list is complete and has no
/// duplicates.
///
/// When corners of a triangle coincide, the smaller index names the point. When corners are collinear, the
/// edge between the two outer corners names the segment.
///
/// A point has one extreme point, a segment two, a polygon (of coplanar triangles) three to six. The points
/// of a segment are in ascending order of (on_a, on_b). A polygon is in convex order; it starts at the
/// smallest (on_a, on_b) and continues with the smaller of its two neighbours.
///
/// Cost: about 100 ns more than the decision for each point that is not a vertex.
///
/// Positions: a vertex has its own bits (those of a where two vertices meet). Any other point lies on an
/// edge. Its error along each axis is at most 2^-44 of the edge's extent plus half a unit in the last place,
/// and it is never outside the box of either triangle. It depends on that edge and the opposite edge or face
/// alone, not on the direction of the edge or the order of the triangles, so triangles that share an edge
/// report the same bits there. Another order of the face's corners can change the last bits.
///
/// Normal: the direction of the shortest translation of triangle a that separates the triangles: afterwards a
/// plane perpendicular to the normal has each triangle on one of its closed sides, a on the side to which the
/// normal points.
/// - Triangles that cross in a segment: the direction of least penetration among the normals of both and the
///   cross products of an edge of each, with either sign.
/// - Triangles that touch, in a point or a segment: no translation is needed; the normal is the one of those
///   directions whose plane separates the triangles. For a vertex on a face that is the normal of the face.
/// - Coplanar triangles: the common normal with the sign of the normal of b (counter-clockwise corners).
/// - A triangle without area, or with an angle below 2^-20: it acts as the segment or the point that it
///   spans. When both lie on one line, the normal is perpendicular to the line. When both are one point, the
///   normal is the x axis.
/// The normal is rounded: computed in double, in a fixed order of operations, with the same bits on every
/// machine. Two edges at an angle below 2^-20 count as parallel, and triangles within 2^-32 of their size
/// from a common plane count as coplanar.
TriangleIntersection intersect_triangles(const TrianglePoints& a, const TrianglePoints& b);

/// Makes the same decision as `triangles_intersect` by separating axes and integers of unlimited size, for
/// checking. It shares no code with that function and uses no floating-point arithmetic. Takes 2 to 12
/// microseconds for coordinates of ordinary size.
bool triangles_intersect_by_axes(const TrianglePoints& a, const TrianglePoints& b);

}  // namespace supple
