#pragma once

#include <array>
#include <limits>
#include <optional>

#include "supple/contact.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple {

/// The ends of a closed edge. Equal ends make it a point.
using EdgePoints = std::array<Vec3d, 2>;

/// The closest points of two closed elements a and b: points, edges or triangles.
///
/// The features are exact: the smallest parts of the elements that hold the closest points. A point is vertex
/// 0. Edge 0 of an edge is the edge without its ends, and the face of a triangle is its interior. Where
/// several features hold them, which needs parallel edges, an edge without length or a triangle without area,
/// the smallest counts: two vertices before a vertex of a and an edge of b, before an edge of a and a vertex
/// of b; then the smaller index on a, then on b. The edges of a triangle count in the order (0, 1), (0, 2),
/// (1, 2).
struct ElementDistance {
  /// Within 4 units in the last place of the exact distance; infinite where no double holds it.
  double distance = 0;
  Feature on_a, on_b;
  /// The closest points in barycentric coordinates of the element's vertices: 1, 0, 0 for a point; 1 - s, s,
  /// 0 for an edge; one coordinate for each corner of a triangle. Rounded, each to within 2^-50.
  std::array<double, 3> barycentric_a{}, barycentric_b{};
  Vec3d point_a, point_b;  ///< rounded: combinations of the vertices
  /// Unit vector from the closest point of b to that of a. Where the distance is 0: the normal of the
  /// triangle by the right-hand rule, or of both edges (a's cross b's); else a unit vector across the edge,
  /// or the x axis for two points.
  Vec3d normal;

  constexpr bool operator==(const ElementDistance&) const = default;
};

// Distances of points, edges and triangles. All finite coordinates are allowed. Nothing is returned when a
// coordinate is not finite, or when the elements are farther apart than `max_distance`, as exact arithmetic
// decides (a distance equal to it counts). A bound saves the time to compute the rest of the result. Throws
// `Error` when `max_distance` is negative or NaN.
//
// Takes 0.1 to 0.3 µs. When only integers can decide, it takes some microseconds and allocates memory.

/// The bound that leaves out nothing.
inline constexpr double any_distance = std::numeric_limits<double>::infinity();

/// The distance and the closest points of two elements; nothing when they are farther apart or not finite.
std::optional<ElementDistance> point_point_distance(const Vec3d& a, const Vec3d& b,
                                                    double max_distance = any_distance);
std::optional<ElementDistance> point_edge_distance(const Vec3d& a, const EdgePoints& b,
                                                   double max_distance = any_distance);
std::optional<ElementDistance> point_triangle_distance(const Vec3d& a, const TrianglePoints& b,
                                                       double max_distance = any_distance);
std::optional<ElementDistance> edge_edge_distance(const EdgePoints& a, const EdgePoints& b,
                                                  double max_distance = any_distance);

}  // namespace supple
