#pragma once

#include <array>
#include <cstdint>

#include "supple/continuous.hpp"
#include "supple/types.hpp"

namespace supple {

/// Part of a triangle on which a point of an intersection lies: the smallest such part.
enum class FeatureKind : std::uint8_t { vertex, edge, face };

/// `index` is the corner (0, 1, 2) of a vertex; of an edge, the corner it starts from, so edge i joins
/// corners i and (i + 1) mod 3; 0 for the face.
struct Feature {
  FeatureKind kind = FeatureKind::face;
  std::uint8_t index = 0;

  constexpr auto operator<=>(const Feature&) const = default;
};

/// An extreme point of the intersection of two triangles: where feature a meets feature b.
struct ContactPoint {
  Vec3d position;  ///< rounded from the exact point; `on_a` and `on_b` are exact
  Feature on_a, on_b;

  constexpr bool operator==(const ContactPoint&) const = default;
};

/// What two intersecting closed triangles share.
enum class IntersectionKind : std::uint8_t { point, segment, polygon };

/// Two triangles that truly intersect, as exact arithmetic decides on the given coordinates. Touching counts.
struct Contact {
  ObjectId object_a, object_b;                   ///< equal for a contact of an object with itself
  std::uint32_t triangle_a = 0, triangle_b = 0;  ///< the user's numbers; a < b within one object
  IntersectionKind kind = IntersectionKind::segment;
  /// 1 for a point, 2 for a segment, 3 to 6 for a polygon (convex, in order around it).
  std::uint8_t point_count = 0;
  /// Of the first point in `DetectResult::contact_points`.
  std::uint32_t first_point = 0;

  constexpr bool operator==(const Contact&) const = default;
};

/// Which elements of the objects a and b of a continuous contact touch. Of one object with itself there is no
/// `face_vertex`: the vertex is then the element of a.
enum class ElementPairKind : std::uint8_t { vertex_face, face_vertex, edge_edge };

/// Two elements that touch within the step. Edges are the distinct pairs of vertices of the triangles; within
/// one object elements that share a vertex id are not a contact, and edge a is the smaller.
struct ContinuousContact {
  ObjectId object_a, object_b;  ///< equal for a contact of an object with itself
  ElementPairKind kind = ElementPairKind::vertex_face;
  /// The user's numbers: {v, v} of a vertex, its two vertices of an edge, the smaller first, {t, t} of a
  /// face, t being the triangle.
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  ImpactCertainty certainty = ImpactCertainty::certain;
  /// When they first touch: in [0, 1], never late, early by `toi_tolerance` at most.
  double toi = 0;
  /// Where on each element: 1, 0, 0 of a vertex; 1 - s, s, 0 along an edge; barycentric in a face.
  std::array<double, 3> barycentric_a{}, barycentric_b{};
  Vec3d point;   ///< midway between the two points, at `toi`
  Vec3d normal;  ///< unit vector, towards the side of element a before the impact; see `Impact`

  constexpr bool operator==(const ContinuousContact&) const = default;
};

}  // namespace supple
