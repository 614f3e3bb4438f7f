#include "contact/triangle_gap.hpp"

#include <cmath>

#include "contact/closest_points.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// The shortest way from a to b found so far.
struct ShortestWay {
  Vec3d way;
  double squared_length = INFINITY;

  void consider(const Vec3d& candidate, double squared) {
    if (!(squared < squared_length)) return;
    way = candidate;
    squared_length = squared;
  }
};

/// Multiplied by a power of two, so that no square overflows and few underflow.
TrianglePoints scaled(const TrianglePoints& points, int exponent) {
  TrianglePoints result = points;
  for (Vec3d& p : result) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::ldexp(p[axis], exponent);
  }
  return result;
}

int exponent_of(const TrianglePoints& a, const TrianglePoints& b) {
  double largest = 0;
  for (const TrianglePoints* points : {&a, &b}) {
    for (const Vec3d& p : *points) largest = std::max(largest, largest_magnitude(p));
  }
  return largest > 0 ? std::ilogb(largest) : 0;
}

}  // namespace

/// Triangles that do not meet are closest at a corner of one and a point of the other, or at points of two
/// edges.
TriangleGap triangle_gap(const TrianglePoints& a, const TrianglePoints& b) {
  const int exponent = exponent_of(a, b);
  const TrianglePoints p = scaled(a, -exponent), q = scaled(b, -exponent);
  ShortestWay shortest;
  for (std::size_t i = 0; i < 3; ++i) {
    const ClosestPoints of_a = closest_points(relative_vertex_face({p[i], q[0], q[1], q[2]}), false);
    shortest.consider(-1.0 * of_a.difference, of_a.squared_distance);
    const ClosestPoints of_b = closest_points(relative_vertex_face({q[i], p[0], p[1], p[2]}), false);
    shortest.consider(of_b.difference, of_b.squared_distance);
    for (std::size_t j = 0; j < 3; ++j) {
      const ClosestPoints of_edges =
          closest_points(relative_edge_edge({p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3]}), true);
      shortest.consider(-1.0 * of_edges.difference, of_edges.squared_distance);
    }
  }
  const double distance = length(shortest.way);
  if (!(distance > 0)) return {};
  return {shortest.way * (1 / distance), std::ldexp(distance, exponent)};
}

}  // namespace supple
