#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "supple/continuous.hpp"
#include "supple/types.hpp"

namespace supple {

/// The smallest part of a triangle on which a point of an intersection lies.
enum class FeatureKind : std::uint8_t { vertex, edge, face };

/// `index` of a vertex is its corner (0, 1, 2). `index` of an edge is the corner where it starts: edge i
/// joins corners i and (i + 1) mod 3. `index` of the face is 0.
struct Feature {
  FeatureKind kind = FeatureKind::face;
  std::uint8_t index = 0;

  constexpr auto operator<=>(const Feature&) const = default;
};

/// An extreme point of the intersection of two triangles: feature a meets feature b there.
struct ContactPoint {
  Vec3d position;      ///< rounded from the exact point; `intersect_triangles` states the error
  Feature on_a, on_b;  ///< exact

  constexpr bool operator==(const ContactPoint&) const = default;
};

/// What two intersecting closed triangles share.
enum class IntersectionKind : std::uint8_t { point, segment, polygon };

/// Two triangles that intersect, as exact arithmetic decides on the given coordinates. Touching counts.
///
/// The pair, its `kind`, `point_count` and the features of its points are exact. The normal and the positions
/// of the points are rounded. All have the same bits for any number of threads, instruction set and compiler.
struct Contact {
  ObjectId object_a, object_b;                   ///< equal for a contact of an object with itself
  std::uint32_t triangle_a = 0, triangle_b = 0;  ///< the user's numbers; a < b within one object
  IntersectionKind kind = IntersectionKind::segment;
  /// 1 for a point, 2 for a segment, 3 to 6 for a polygon (convex, in order around it).
  std::uint8_t point_count = 0;
  /// Index of the first point in `DetectResult::contact_points`.
  std::uint32_t first_point = 0;
  /// Unit vector from b to a: the direction of the shortest translation of triangle a that separates the two;
  /// see `separating_normal`. Zero when `SceneOptions::contact_points` is off.
  Vec3d normal{};

  constexpr bool operator==(const Contact&) const = default;
};

/// The kinds of the two elements of a continuous contact: first of object a, then of object b. A contact of
/// an object with itself is never `face_vertex` or `edge_vertex`: its element a is the vertex. The last three
/// occur with `ObjectOptions::edges` and `points`: a vertex and an edge or a point of these lists.
enum class ElementPairKind : std::uint8_t {
  vertex_face,
  face_vertex,
  edge_edge,
  vertex_edge,
  edge_vertex,
  vertex_vertex,
};

/// The kinds of element a and of element b.
constexpr std::array<FeatureKind, 2> feature_kinds(ElementPairKind kind) {
  using enum FeatureKind;
  switch (kind) {
    case ElementPairKind::vertex_face:
      return {vertex, face};
    case ElementPairKind::face_vertex:
      return {face, vertex};
    case ElementPairKind::edge_edge:
      return {edge, edge};
    case ElementPairKind::vertex_edge:
      return {vertex, edge};
    case ElementPairKind::edge_vertex:
      return {edge, vertex};
    case ElementPairKind::vertex_vertex:
      break;
  }
  return {vertex, vertex};
}

/// Two elements that touch on their paths within the step. Bodies that already cut through each other at the
/// start of the step have no continuous contact until two of their elements touch; `Contact` reports them.
/// Edges are the distinct pairs of vertices of the triangles and those of `ObjectOptions::edges`. Within one
/// object, elements that share a vertex id are not a contact, and edge a or vertex a is the smaller one.
///
/// With `ImpactCertainty::certain`, the pair is exact. `toi`, the barycentric coordinates, `point` and
/// `normal` are rounded.
struct ContinuousContact {
  ObjectId object_a, object_b;  ///< equal for a contact of an object with itself
  ElementPairKind kind = ElementPairKind::vertex_face;
  /// The user's numbers: {v, v} for a vertex v, {v, w} with v < w for an edge, {t, t} for the face of
  /// triangle t. `Scene::vertices_of` gives the vertex ids.
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  ImpactCertainty certainty = ImpactCertainty::certain;
  bool touching_at_start = false;  ///< exact; see `Impact`
  /// Time of impact, at which they first touch, in [0, 1]: never late, and early by at most
  /// `toi_tolerance_at`. Positive when they are apart at the start; see `Impact`.
  double toi = 0;
  double start_distance = 0;  ///< at the start of the step; see `Impact`
  /// The point of each element that touches, in barycentric coordinates of the element's vertices: 1, 0, 0
  /// for a vertex; 1 - s, s, 0 for an edge; one coordinate for each corner of a face.
  std::array<double, 3> barycentric_a{}, barycentric_b{};
  Vec3d point;   ///< midpoint of the two points at `toi`
  Vec3d normal;  ///< unit vector from b to the side of element a before the impact; see `Impact`

  constexpr bool operator==(const ContinuousContact&) const = default;
};

/// The two objects of a contact.
enum class ContactSide : std::uint8_t { a, b };

/// The vertex ids of an element: one for a vertex, two for an edge, three for a face.
struct ElementVertices {
  std::array<std::uint32_t, 3> ids{};
  std::uint8_t count = 0;

  std::size_t size() const { return count; }
  std::uint32_t operator[](std::size_t i) const { return ids[i]; }
  const std::uint32_t* begin() const { return ids.data(); }
  const std::uint32_t* end() const { return ids.data() + count; }
};

}  // namespace supple
