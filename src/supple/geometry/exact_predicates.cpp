#include "geometry/exact_predicates.hpp"

#include <array>

#include "geometry/numbers/integer_points.hpp"
#include "geometry/plane_filter.hpp"

namespace supple {
namespace {

/// True when both products in the component of u × v along `axis` have a factor 0. A difference of doubles
/// is 0 only for equal doubles, so this is exact.
bool has_no_product(const Vec3d& u, const Vec3d& v, int axis) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  return (u[x] == 0 || v[y] == 0) && (u[y] == 0 || v[x] == 0);
}

/// True when every product of the determinant has a factor 0, as for equal coordinates in flat or touching
/// parts.
bool plainly_coplanar(const Vec3d& u, const Vec3d& v, const Vec3d& w) {
  return (w.x == 0 || has_no_product(u, v, 0)) && (w.y == 0 || has_no_product(u, v, 1)) &&
         (w.z == 0 || has_no_product(u, v, 2));
}

}  // namespace

int orient3d(const FilteredPlane& plane, const Vec3d& b, const Vec3d& c, const Vec3d& d, bool& used_exact) {
  const Filtered side = plane.side(d);
  if (side.certain()) return side.sign();
  const Vec3d& a = plane.origin;
  if (d == b || d == c || plainly_coplanar(b - a, c - a, d - a)) return 0;
  used_exact = true;
  return with_integers(std::array{a, b, c, d}, std::array{0, 1, 2}, [](const auto& p) {
    return sign(determinant(difference(p[1], p[0]), difference(p[2], p[0]), difference(p[3], p[0])));
  });
}

int orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d, bool& used_exact) {
  return orient3d(FilteredPlane(a, b, c), b, c, d, used_exact);
}

int orient2d(const Vec3d& a, const Vec3d& b, const Vec3d& c, int axis, bool& used_exact) {
  const Filtered turn = filtered_turn(a, b, c, axis);
  if (turn.certain()) return turn.sign();
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  if ((b[x] == c[x] && b[y] == c[y]) || has_no_product(b - a, c - a, axis)) return 0;
  used_exact = true;
  return with_integers(std::array{a, b, c}, std::array{x, y}, [](const auto& p) {
    return sign(determinant(difference(p[1], p[0]), difference(p[2], p[0])));
  });
}

Projection find_projection(const Vec3d& a, const Vec3d& b, const Vec3d& c, bool& used_exact) {
  // Start with the largest component, because the filter most likely decides it.
  const Vec3d normal = absolute(FilteredPlane(a, b, c).normal);
  const int first = normal.x >= normal.y && normal.x >= normal.z ? 0 : normal.y >= normal.z ? 1 : 2;
  for (int i = 0; i < 3; ++i) {
    const int axis = (first + i) % 3;
    if (const int turn = orient2d(a, b, c, axis, used_exact)) return {axis, turn};
  }
  return {};
}

}  // namespace supple
