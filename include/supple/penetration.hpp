#pragma once

#include <array>
#include <cstdint>

#include "supple/contact.hpp"
#include "supple/description.hpp"
#include "supple/types.hpp"

namespace supple {

/// A vertex of one object inside another object, which is solid. A vertex that is on the surface is not
/// inside. Exact, but for the rounded numbers.
struct Penetration {
  ObjectId object_a, object_b;  ///< the vertex is of a, and b is solid
  std::uint32_t vertex = 0;     ///< the user's number
  /// The triangle of b that is nearest, by the user's number: the smallest of several at the same distance.
  std::uint32_t triangle = 0;
  Feature feature{};  ///< the smallest part of the triangle that holds the closest point
  double depth = 0;   ///< distance to the surface of b, within 4 units in the last place
  /// The closest point by the triangle's corners, each coordinate within 2^-50.
  std::array<double, 3> barycentric{};
  Vec3d point{};   ///< the closest point, rounded
  Vec3d normal{};  ///< unit vector from the vertex to that point: the shortest way out of b

  constexpr bool operator==(const Penetration&) const = default;
};

/// The vertices of a that are inside b or on its surface: ranges of `DetectResult::penetrations` and of
/// `DetectResult::vertices_on_surface`, each with ascending vertices. Only pairs with such a vertex are
/// listed. The vertices of b inside a are a group of their own.
struct PenetrationGroup {
  ObjectId a, b;
  std::uint32_t first_penetration = 0;
  std::uint32_t penetration_count = 0;
  std::uint32_t first_on_surface = 0;
  std::uint32_t on_surface_count = 0;

  constexpr bool operator==(const PenetrationGroup&) const = default;
};

/// A connected part of an object that is inside a solid object and touches no triangle of it. Triangles that
/// share a vertex id are connected.
struct ContainedPart {
  ObjectId inner, outer;
  std::uint32_t vertex = 0;  ///< the smallest vertex of the part
  std::uint32_t vertex_count = 0;
  bool is_whole = false;  ///< all parts of `inner` are contained in `outer`

  constexpr bool operator==(const ContainedPart&) const = default;
};

/// How the contacts of a curve are linked.
enum class CurveKind : std::uint8_t {
  closed,    ///< a loop of segments
  open,      ///< a chain of segments with two ends
  branched,  ///< everything else: more than two contacts meet in a point, or triangles share more or less
             ///< than a segment
};
template <>
inline constexpr std::array words<CurveKind>{"closed", "open", "branched"};

/// A curve in which two objects intersect, or one object intersects itself: the contacts that are linked by
/// common points. A point links two contacts when it lies on the same features of both objects, for example
/// on an edge of a and a face of b. So the links are exact.
///
/// A closed or an open curve runs from point to point, a contact between each two, in the direction n_b x n_a
/// of the normals of the triangles. A closed one starts with its smallest contact. A branched one has
/// ascending contacts and no points.
///
/// On each of two surfaces, a curve encloses the vertices that it cuts off: those on the smaller of the two
/// sides, by the number of vertices, and of equal sides the one inside the other object. It encloses nothing
/// where it does not divide the connected part of the surface, and where a vertex makes the sides ambiguous.
/// On a curve of an object with itself, side a has the smaller triangle of the curve's smallest contact. See
/// Baraff, Witkin and Kass, Untangling Cloth, 2003.
///
/// `normal` and `depth` say how a leaves b: after a moves by `depth` along `normal`, no vertex of the contact
/// is inside the other object, and two convex objects have no common inside. So the depth is at least that of
/// the deepest vertex of the contact, and at most the overlap of two convex objects along the normal.
///
/// The contact is what is behind the curve on each surface: the triangles of the curve's contacts, and those
/// around the vertices that are behind the other surface and that edges without contacts connect to the
/// curve. Exact signs decide what is behind, so vertices that are on the other surface hide nothing. Where a
/// part goes through the other object, so that it is in front again beyond another curve, its far end belongs
/// to the contact, too, unless it has many more vertices than the curve has contacts. Where the other object
/// is not solid, or the same one, the contact has at most 64 + 16 n + n² / 4 vertices of a side for n
/// contacts, those nearest to the curve by edges. O(n log n) for n triangles of the contact, and the rays.
///
/// The depth along a direction is the longest way, in this direction, from a point of a to a point of b
/// straight ahead; rays from vertices inside add the triangles through which these leave. Triangles parallel
/// to the direction have nothing ahead, and triangles that touch only beside each other are not ahead of each
/// other: sides that slide past each other do not count. Between two objects, the longest way goes on from
/// its ends to triangles beside them while these have a longer one: a also leaves what it would only enter on
/// its way. So convex objects are apart after the move. Where the longest way begins in the front of a
/// solid a, or ends in the back of a solid b, the other side there counts, too. A direction in which nothing
/// is ahead counts only where all are such; the depth is then 0, as for surfaces that only touch.
///
/// `normal` has the least depth of these: the outward normals of the faces of b, and the reverse of those of
/// a, on which the curve lies (of more than twelve, those of at least an eighth of the curve); the direction
/// of the curve's area, or of its segments when it is not closed; and the shortest moves out of two or three
/// of these faces at once, where no face alone is shorter. Where there are none, it is the mean direction of
/// the contacts' normals by length. Contacts in which one triangle is nowhere behind the other only touch:
/// their faces count where there are no others. Of several directions with the same depth (within 2^-36), it
/// is the one with the largest x, then y, then z component, by magnitude. A depth of at most 2^-49 of the
/// largest coordinate is rounding and can be too long. A small move can change the normal, but hardly the
/// depth. To exchange a and b reverses the normal, unless opposite directions have the same depth.
struct IntersectionCurve {
  ObjectId a, b;  ///< equal for a curve of an object with itself
  CurveKind kind = CurveKind::closed;
  std::uint32_t first_contact = 0, contact_count = 0;  ///< of `DetectResult::curve_contacts`
  std::uint32_t first_point = 0, point_count = 0;      ///< of `DetectResult::curve_points`
  /// Of `DetectResult::enclosed_vertices`: first those of a, then those of b, each ascending.
  std::uint32_t first_enclosed = 0, enclosed_count_a = 0, enclosed_count_b = 0;
  // Rounded, with the same bits for any number of threads.
  Vec3d centroid{};  ///< of the segments by their lengths
  /// The vector area of the polygon of the points of a closed curve, by the right-hand rule; else zero. It
  /// points to the side of a when the normals of both surfaces point outwards.
  Vec3d area{};
  Vec3d normal{};    ///< unit vector along which a leaves b
  double depth = 0;  ///< how far a must move along `normal`; 0 where the parts only touch

  constexpr bool operator==(const IntersectionCurve&) const = default;
};

}  // namespace supple
