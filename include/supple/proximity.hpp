#pragma once

#include <array>
#include <cstdint>

#include "supple/contact.hpp"
#include "supple/types.hpp"

namespace supple {

/// What a list of proximity pairs contains.
enum class ProximityListing : std::uint8_t {
  /// Each pair of features once: two vertices, a vertex and the inside of an edge or of a face, or the
  /// insides of two edges; and each edge that crosses a face. What a solver needs: one pair for each
  /// constraint.
  features,
  /// Every vertex and face and every two edges within the margins, with their closest points; and each edge
  /// that crosses a face.
  elements,
};

/// Two features or elements whose distance is at most the sum of the margins of their objects, or twice the
/// margin within one object. Exact arithmetic decides this on the given coordinates, and which features hold
/// the closest points; `distance.hpp` says which where several do. The sum is rounded to double once.
///
/// An edge and a face are a pair at distance 0 where the inside of the edge crosses the inside of the face,
/// with its ends on different sides of the plane: surfaces that cut through each other are near, also away
/// from all other edges and vertices. Each other point of an edge and a face is in a pair of a vertex and the
/// face or of two edges at distance 0. So each point is named once. Such a pair is the same in both listings
/// and for all margins. `ElementKinds::vertex_face` and `edge_edge` leave it out.
///
/// Within one object, elements that share a vertex id are left out. So features that share one occur only
/// through other elements. A vertex stands before an edge or a face there, and the smaller of two vertices or
/// edges stands first.
struct ProximityPair {
  ObjectId object_a, object_b;  ///< equal for a pair of an object with itself
  /// The kinds of the pair: vertex and vertex, vertex and edge, vertex and face, or edge and edge, in any
  /// order. In the listing of elements: vertex and face, face and vertex, or edge and edge. In both: edge and
  /// face, or face and edge.
  FeatureKind kind_a = FeatureKind::vertex, kind_b = FeatureKind::vertex;
  /// The user's numbers: {v, v} for a vertex v, {v, w} with v < w for an edge, {t, t} for the face of
  /// triangle t. `Scene::vertices_of` gives the vertex ids.
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  /// The smallest features of the elements that hold the closest points, exact. Corner i of an edge {v, w} is
  /// v or w. In the listing of features: the whole feature, with index 0.
  Feature on_a, on_b;
  double distance = 0;  ///< within 4 units in the last place of the exact distance
  /// The closest points in barycentric coordinates of the element's vertices: 1, 0, 0 for a vertex; 1 - s, s,
  /// 0 for an edge; one coordinate for each corner of a face.
  std::array<double, 3> barycentric_a{}, barycentric_b{};
  Vec3d point_a, point_b;  ///< the closest points
  /// Unit vector from b to a; at distance 0 it is normal to both features. See `ElementDistance`. For an edge
  /// of a that crosses a face of b, the normal of the face by the right-hand rule; for a face of a, the
  /// opposite of its normal.
  Vec3d normal;

  constexpr bool operator==(const ProximityPair&) const = default;
};

}  // namespace supple
