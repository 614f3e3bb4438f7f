#include "geometry/exact_predicates.hpp"

#include <array>
#include <cmath>

#include "geometry/integer_points.hpp"
#include "geometry/plane_filter.hpp"

namespace supple {
namespace {

/// Products of up to three such numbers are 0 only if a factor is 0.
bool zero_or_large(double value) {
  return value == 0 || std::fabs(value) > 0x1p-300;
}
bool zero_or_large(const Vec3d& v) {
  return zero_or_large(v.x) && zero_or_large(v.y) && zero_or_large(v.z);
}

/// Equal coordinates, as in flat or touching parts, make each product 0 by itself.
bool plainly_coplanar(const FilteredPlane& plane, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d& a = plane.origin;
  return dot(plane.magnitude, absolute(d - a)) == 0 && zero_or_large(b - a) && zero_or_large(c - a) &&
         zero_or_large(d - a);
}

int exact_orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const std::array<std::array<double, 4>, 3> coordinates{
      {{a.x, b.x, c.x, d.x}, {a.y, b.y, c.y, d.y}, {a.z, b.z, c.z, d.z}}};
  return with_integers(coordinates, [](const auto& p) {
    return sign(determinant(difference(p[1], p[0]), difference(p[2], p[0]), difference(p[3], p[0])));
  });
}

}  // namespace

int orient3d(const FilteredPlane& plane, const Vec3d& b, const Vec3d& c, const Vec3d& d, bool& used_exact) {
  const Filtered side = plane.side(d);
  if (side.certain()) return side.sign();
  if (d == b || d == c || plainly_coplanar(plane, b, c, d)) return 0;
  used_exact = true;
  return exact_orient3d(plane.origin, b, c, d);
}

int orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d, bool& used_exact) {
  return orient3d(FilteredPlane(a, b, c), b, c, d, used_exact);
}

int orient2d(const Vec3d& a, const Vec3d& b, const Vec3d& c, int axis, bool& used_exact) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double ux = b[x] - a[x], uy = b[y] - a[y], vx = c[x] - a[x], vy = c[y] - a[y];
  const double left = ux * vy, right = uy * vx;
  const double magnitude = std::fabs(left) + std::fabs(right);
  const Filtered turn{left - right, area_error * magnitude + underflow_error};
  if (turn.certain()) return turn.sign();
  if (b[x] == c[x] && b[y] == c[y]) return 0;
  if (magnitude == 0 && zero_or_large(ux) && zero_or_large(uy) && zero_or_large(vx) && zero_or_large(vy)) {
    return 0;
  }
  used_exact = true;
  const std::array<std::array<double, 3>, 2> coordinates{{{a[x], b[x], c[x]}, {a[y], b[y], c[y]}}};
  return with_integers(coordinates, [](const auto& p) {
    return sign(determinant(difference(p[1], p[0]), difference(p[2], p[0])));
  });
}

Projection find_projection(const Vec3d& a, const Vec3d& b, const Vec3d& c, bool& used_exact) {
  // The filter most probably decides the largest component, so that is tried first.
  const Vec3d normal = absolute(FilteredPlane(a, b, c).normal);
  const int first = normal.x >= normal.y && normal.x >= normal.z ? 0 : normal.y >= normal.z ? 1 : 2;
  for (int i = 0; i < 3; ++i) {
    const int axis = (first + i) % 3;
    if (const int turn = orient2d(a, b, c, axis, used_exact)) return {axis, turn};
  }
  return {};
}

}  // namespace supple
