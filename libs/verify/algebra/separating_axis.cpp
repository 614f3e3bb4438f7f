#include <algorithm>
#include <array>
#include <limits>

#include "geometry/numbers/number_vector.hpp"
#include "geometry/vector.hpp"
#include "supple/triangle_intersection.hpp"
#include "verify/algebra/sturm.hpp"

// Decides whether two triangles intersect, for `verify`, by code that detection does not use.
//
// Two convex sets A and B are disjoint exactly when the origin is outside their difference A - B, a convex
// polytope whose edges have the directions of edges of A and of B. By its dimension:
//
// 3: the origin is outside when it is strictly beyond one of the facets. A facet is the difference of a face
//    of A and a face of B with a common normal: a triangle with a vertex, an edge or a triangle, or two edges
//    that are not parallel. So each normal is the product of two edges.
// 2: the polytope spans a plane with normal n, the product of any two edges that are not parallel. The origin
//    is off that plane, and n separates, or in it; then its position decides within the plane, where a side
//    of the polygon is an edge e of A or of B with the normal n × e.
// 1: all edges have one direction d. The origin is off the line through w = a0 - b0 along d, and the part of
//    w across d, d × (w × d), separates; or it is on that line, and d separates if anything does.
// 0: two points. If they differ, w separates them.
//
// An axis that is 0 separates nothing, so triangles without area need no special case.

namespace supple {
namespace {

using sturm::Integer;
using Vector = NumberVector<Integer>;
using Corners = std::array<Vector, 3>;

bool are_disjoint(const Corners& a, const Corners& b) {
  const auto separates = [&](const Vector& axis) {
    if (axis == Vector{}) return false;
    const auto [a_low, a_high] = std::minmax({dot(axis, a[0]), dot(axis, a[1]), dot(axis, a[2])});
    const auto [b_low, b_high] = std::minmax({dot(axis, b[0]), dot(axis, b[1]), dot(axis, b[2])});
    return a_high < b_low || b_high < a_low;
  };
  const std::array edges{minus(a[1], a[0]), minus(a[2], a[1]), minus(a[0], a[2]),
                         minus(b[1], b[0]), minus(b[2], b[1]), minus(b[0], b[2])};
  Vector plane_normal;  // stays 0 when all edges are parallel
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vector normal = cross(edges[i], edges[j]);
      if (separates(normal)) return true;
      if (normal != Vector{}) plane_normal = normal;
    }
  }
  const auto leaves_plane = [&](const Vector& edge) { return dot(plane_normal, edge) != 0; };
  const auto side_separates = [&](const Vector& edge) { return separates(cross(plane_normal, edge)); };
  if (std::ranges::any_of(edges, leaves_plane)) return false;
  if (plane_normal != Vector{}) return std::ranges::any_of(edges, side_separates);
  const Vector between = minus(a[0], b[0]);
  const auto line_separates = [&](const Vector& edge) {
    return separates(edge) || separates(cross(edge, cross(between, edge)));
  };
  return separates(between) || std::ranges::any_of(edges, line_separates);
}

/// The exponent of the lowest bit of all coordinates of one axis. Scaling an axis by a power of two is a
/// linear map and leaves disjoint sets disjoint.
int lowest_bit_along(int axis, const TrianglePoints& a, const TrianglePoints& b) {
  int lowest = std::numeric_limits<int>::max();
  for (const TrianglePoints* triangle : {&a, &b}) {
    for (const Vec3d& point : *triangle) lowest = std::min(lowest, sturm::lowest_bit(point[axis]));
  }
  return lowest;
}

}  // namespace

bool triangles_intersect_by_axes(const TrianglePoints& a, const TrianglePoints& b) {
  if (!std::ranges::all_of(a, is_finite) || !std::ranges::all_of(b, is_finite)) return false;
  Corners corners_a, corners_b;
  for (int axis = 0; axis < 3; ++axis) {
    const int lowest = lowest_bit_along(axis, a, b);
    for (std::size_t i = 0; i < 3; ++i) {
      corners_a[i][axis] = sturm::to_integer(a[i][axis], lowest);
      corners_b[i][axis] = sturm::to_integer(b[i][axis], lowest);
    }
  }
  return !are_disjoint(corners_a, corners_b);
}

}  // namespace supple
