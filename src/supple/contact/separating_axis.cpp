#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "supple/triangle_intersection.hpp"

// Two convex sets A and B are disjoint exactly when the origin is outside their difference A - B, a convex
// polytope whose edges have the directions of edges of A and of B. By its dimension:
//
// 3: the origin is outside when it is strictly beyond one of the facets. A facet is the difference of a face
//    of A and a face of B with a common normal: a triangle with a vertex, an edge or a triangle, or two edges
//    that are not parallel. So the normals are those of A and of B and the products of their edges.
// 2: the polytope spans a plane with normal n, the product of any two edges that are not parallel. The origin
//    is off that plane, and n separates, or in it; then its position decides within the plane, where a side
//    of the polygon is an edge e of A or of B with the normal n × e.
// 1: all edges have one direction d. The origin is off the line through w = a0 - b0 along d, and the part of
//    w across d, d × (w × d), separates; or it is on that line, and d separates if anything does.
// 0: two points, different exactly when one of the coordinate axes separates them.
//
// An axis that is 0 separates nothing, so triangles without area need no special case.

namespace supple {
namespace {

namespace mp = boost::multiprecision;
using Unbounded = mp::number<mp::cpp_int_backend<>, mp::et_off>;
using Fixed =
    mp::number<mp::cpp_int_backend<1024, 1024, mp::signed_magnitude, mp::unchecked, void>, mp::et_off>;

template <class Int>
using Vector = std::array<Int, 3>;

template <class Int>
Vector<Int> minus(const Vector<Int>& a, const Vector<Int>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Int>
Vector<Int> cross(const Vector<Int>& a, const Vector<Int>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class Int>
bool is_zero(const Vector<Int>& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

template <class Int>
struct Solid {
  std::array<Vector<Int>, 3> points, edges;

  explicit Solid(const std::array<Vector<Int>, 3>& corners)
      : points(corners),
        edges{minus(points[1], points[0]), minus(points[2], points[1]), minus(points[0], points[2])} {}
};

template <class Int>
class AxisSearch {
 public:
  AxisSearch(const Solid<Int>& a, const Solid<Int>& b) : a_(a), b_(b) {}

  bool disjoint() const {
    Vector<Int> plane_normal{}, line_direction{};
    switch (dimension(plane_normal, line_direction)) {
      case 3:
        return any_facet_separates();
      case 2:
        return any_separates_in_plane(plane_normal);
      case 1:
        return any_separates_on_line(line_direction);
      default:
        return a_.points[0] != b_.points[0];
    }
  }

 private:
  std::array<Vector<Int>, 6> edges() const {
    return {a_.edges[0], a_.edges[1], a_.edges[2], b_.edges[0], b_.edges[1], b_.edges[2]};
  }

  int dimension(Vector<Int>& normal, Vector<Int>& direction) const {
    int found = 0;
    for (const Vector<Int>& edge : edges()) {
      if (found == 0 && !is_zero(edge)) {
        direction = edge;
        found = 1;
      } else if (found == 1) {
        normal = cross(direction, edge);
        if (!is_zero(normal)) found = 2;
      } else if (found == 2) {
        if (project(normal, edge) != 0) return 3;
      }
    }
    return found;
  }

  static Int project(const Vector<Int>& axis, const Vector<Int>& point) {
    return axis[0] * point[0] + axis[1] * point[1] + axis[2] * point[2];
  }

  bool separates(const Vector<Int>& axis) const {
    if (is_zero(axis)) return false;
    std::array<Int, 3> on_a, on_b;
    for (std::size_t i = 0; i < 3; ++i) {
      on_a[i] = project(axis, a_.points[i]);
      on_b[i] = project(axis, b_.points[i]);
    }
    const auto [a_low, a_high] = std::minmax_element(on_a.begin(), on_a.end());
    const auto [b_low, b_high] = std::minmax_element(on_b.begin(), on_b.end());
    return *a_high < *b_low || *b_high < *a_low;
  }

  bool any_facet_separates() const {
    if (separates(cross(a_.edges[0], a_.edges[1]))) return true;
    if (separates(cross(b_.edges[0], b_.edges[1]))) return true;
    for (const Vector<Int>& edge_a : a_.edges) {
      for (const Vector<Int>& edge_b : b_.edges) {
        if (separates(cross(edge_a, edge_b))) return true;
      }
    }
    return false;
  }

  bool any_separates_in_plane(const Vector<Int>& normal) const {
    if (separates(normal)) return true;
    for (const Vector<Int>& edge : edges()) {
      if (separates(cross(normal, edge))) return true;
    }
    return false;
  }

  bool any_separates_on_line(const Vector<Int>& direction) const {
    const Vector<Int> between = minus(a_.points[0], b_.points[0]);
    return separates(cross(direction, cross(between, direction))) || separates(direction);
  }

  const Solid<Int>&a_, &b_;
};

/// value = fraction · 2^exponent, |fraction| < 2^53.
struct Parts {
  std::int64_t fraction;
  int exponent;

  explicit Parts(double value) {
    int power = 0;
    fraction = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &power), 53));
    exponent = power - 53;
  }
};

/// The lowest exponent of one axis, and how many bits its coordinates take above that. Scaling an axis by a
/// power of two is a linear map and leaves sets apart that are apart.
struct Span {
  int lowest, bits;
};

Span axis_span(const TrianglePoints& a, const TrianglePoints& b, int axis) {
  int lowest = 4000, highest = -4000;
  for (const TrianglePoints* triangle : {&a, &b}) {
    for (const Vec3d& point : *triangle) {
      const Parts parts(point[axis]);
      if (parts.fraction == 0) continue;
      lowest = std::min(lowest, parts.exponent);
      highest = std::max(highest, parts.exponent);
    }
  }
  return highest < lowest ? Span{0, 0} : Span{lowest, highest - lowest + 53};
}

template <class Int>
Solid<Int> to_solid(const TrianglePoints& triangle, const std::array<Span, 3>& spans) {
  std::array<Vector<Int>, 3> points;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Parts parts(triangle[i][static_cast<int>(axis)]);
      points[i][axis] = parts.fraction;
      if (parts.fraction != 0) points[i][axis] <<= parts.exponent - spans[axis].lowest;
    }
  }
  return Solid<Int>(points);
}

template <class Int>
bool intersect(const TrianglePoints& a, const TrianglePoints& b, const std::array<Span, 3>& spans) {
  return !AxisSearch<Int>(to_solid<Int>(a, spans), to_solid<Int>(b, spans)).disjoint();
}

bool finite(const TrianglePoints& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [](const Vec3d& point) {
    return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
  });
}

}  // namespace

bool triangles_intersect_by_axes(const TrianglePoints& a, const TrianglePoints& b) {
  if (!finite(a) || !finite(b)) return false;
  const std::array<Span, 3> spans{axis_span(a, b, 0), axis_span(a, b, 1), axis_span(a, b, 2)};
  // The longest axes are products of three differences, and are multiplied by a point: (bits + 1) · 3 + bits,
  // and few more for the sums.
  const int widest = std::max({spans[0].bits, spans[1].bits, spans[2].bits});
  return widest <= 250 ? intersect<Fixed>(a, b, spans) : intersect<Unbounded>(a, b, spans);
}

}  // namespace supple
