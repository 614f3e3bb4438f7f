#include "normals.hpp"

#include <algorithm>
#include <cmath>

namespace supple::viewer {
namespace {

Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double length(const Vec3d& v) {
  return std::hypot(v.x, v.y, v.z);
}

double largest(const Vec3d& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

}  // namespace

Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  Vec3d ab = b - a, ac = c - a;
  // Sides of length 1 or so: products of small or large ones would leave the range of numbers.
  const double size = std::max(largest(ab), largest(ac));
  if (!(size > 0) || !std::isfinite(size)) return {};
  ab = ab * (1 / size);
  ac = ac * (1 / size);
  const Vec3d normal = cross(ab, ac);
  const double sine = length(normal);
  return sine > 0 && std::isfinite(sine) ? normal * (1 / sine) : Vec3d{};
}

double area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return 0.5 * length(cross(b - a, c - a));
}

}  // namespace supple::viewer
