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
/// sides, by the number of vertices, and of equal sides the one that is behind. It encloses nothing where it
/// does not divide the connected part of the surface, and where a vertex makes the sides ambiguous. On a
/// curve of an object with itself, side a has the smaller triangle of the curve's smallest contact. See
/// Baraff, Witkin and Kass, Untangling Cloth, 2003.
///
/// `normal` and `depth` say how a leaves b. They concern two parts: on each surface, the triangles of the
/// curve's contacts and those around the vertices behind it. These are the vertices on the side of the curve
/// that is lower along the direction of its area for a, and higher for b. They are the enclosed vertices
/// where the surface is about level there, and where this side is the larger one and has more vertices than
/// 16 for each contact of the curve and than four times the vertices of the surface divided by the curves of
/// the two objects: so the time is in proportion to contacts, vertices and what is enclosed. The depth along
/// a direction is the longest way, in this direction, from a point of part a to a point of part b straight
/// ahead. So this move brings part a past part b, and a shorter one does not. It is at most the smallest move
/// in this direction after which two convex bodies do not overlap. Triangles parallel to the direction have
/// nothing ahead, and triangles that touch only beside each other are not ahead of each other: sides that
/// slide past each other do not count. A direction in which no point of a has one of b ahead counts only
/// where all are such. Where a body fits into another one so that the curve goes only through its own
/// vertices, no vertex is behind the curve, and the depth is that of the touching faces: 0.
///
/// `normal` is the direction with the least depth of these: the outward normals of faces of b, and the
/// reverse of those of a, on which at least half of the curve lies; and the direction of the area, for other
/// than closed curves that of their segments. Where there are none, it is the mean direction of the contacts'
/// normals by length. Contacts in which one triangle is nowhere behind the other only touch; their faces
/// count where the curve has no other contacts. Where several directions have the same depth (within 2^-36),
/// it is their mean, so that a symmetric curve has a symmetric normal; only where they cancel out, it is the
/// first of them. To exchange a and b reverses the normal.
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
