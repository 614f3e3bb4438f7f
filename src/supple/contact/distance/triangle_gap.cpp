#include "contact/distance/triangle_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "contact/distance/closest_points.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Seen from `origin`, and a quarter in size, so that differences do not overflow.
TrianglePoints quarter(const TrianglePoints& points, const Vec3d& origin) {
  TrianglePoints result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = 0.25 * points[i] - 0.25 * origin;
  return result;
}

int exponent_of(const TrianglePoints& a, const TrianglePoints& b) {
  double largest = 0;
  for (const TrianglePoints* points : {&a, &b}) {
    for (const Vec3d& p : *points) largest = std::max(largest, largest_magnitude(p));
  }
  return largest > 0 ? std::ilogb(largest) : 0;
}

/// Tries directions and keeps the one along which the triangles are furthest apart.
class WidestGap {
 public:
  WidestGap(const TrianglePoints& a, const TrianglePoints& b) : a_(a), b_(b) {}

  void consider(const Vec3d& direction) {
    const double size = norm(direction);
    if (!(size > 0)) return;
    const Vec3d axis = direction * (1 / size);
    const auto [low_a, high_a] = range(a_, axis);
    const auto [low_b, high_b] = range(b_, axis);
    keep(axis, low_b - high_a);
    keep(-1.0 * axis, low_a - high_b);
  }
  TriangleGap gap() const { return gap_; }

 private:
  static std::pair<double, double> range(const TrianglePoints& points, const Vec3d& axis) {
    const double p = dot(points[0], axis), q = dot(points[1], axis), r = dot(points[2], axis);
    return {std::min({p, q, r}), std::max({p, q, r})};
  }
  void keep(const Vec3d& axis, double distance) {
    if (distance > gap_.distance) gap_ = {axis, distance};
  }

  const TrianglePoints &a_, &b_;
  TriangleGap gap_{{}, -INFINITY};
};

/// Triangles that do not meet are closest at a corner of one and a point of the other, or at points of two
/// edges.
Vec3d shortest_way(const TrianglePoints& p, const TrianglePoints& q) {
  ClosestPoints closest;
  closest.squared_distance = INFINITY;
  const auto consider = [&](const ClosestPoints& other) {
    if (other.squared_distance < closest.squared_distance) closest = other;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    consider(closest_points(relative_vertex_face({p[i], q[0], q[1], q[2]}), false));
    consider(closest_points(relative_vertex_face({q[i], p[0], p[1], p[2]}), false));
    for (std::size_t j = 0; j < 3; ++j)
      consider(closest_points(relative_edge_edge({p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3]}), true));
  }
  return closest.difference;
}

}  // namespace

/// Takes the shortest way, unless rounding hides it. Then one of the other axes separates the triangles, also
/// where these have collapsed.
TriangleGap triangle_gap(const TrianglePoints& a, const TrianglePoints& b) {
  TrianglePoints p = quarter(a, a[0]), q = quarter(b, a[0]);
  // A size of 1 lets no square overflow and few underflow.
  const int exponent = exponent_of(p, q);
  for (TrianglePoints* const triangle : {&p, &q}) {
    for (Vec3d& corner : *triangle) corner = scaled(corner, -exponent);
  }
  WidestGap widest(p, q);
  widest.consider(shortest_way(p, q));
  const std::array edges{p[1] - p[0], p[2] - p[1], p[0] - p[2], q[1] - q[0], q[2] - q[1], q[0] - q[2]};
  for (const Vec3d& edge : edges) {
    widest.consider(edge);
    for (const Vec3d& other : edges) {
      const Vec3d normal = cross(edge, other);
      widest.consider(normal);
      widest.consider(cross(normal, edge));
    }
  }
  const TriangleGap gap = widest.gap();
  return {gap.axis, std::ldexp(std::max(gap.distance, 0.0), exponent + 2)};
}

}  // namespace supple
