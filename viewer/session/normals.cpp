#include "normals.hpp"

#include <algorithm>
#include <cmath>

namespace supple::viewer {
namespace {

double largest(const Vec3d& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

/// Twice the area vector of a triangle whose sides are divided by `size`, the largest coordinate of two of
/// them. The division avoids overflow and underflow of products. Zero when `size` is 0.
Vec3d scaled_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c, double& size) {
  const Vec3d ab = b - a, ac = c - a;
  size = std::max(largest(ab), largest(ac));
  if (!(size > 0) || !std::isfinite(size)) return {};
  return cross(ab * (1 / size), ac * (1 / size));
}

}  // namespace

Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  double size = 0;
  const Vec3d normal = scaled_normal(a, b, c, size);
  const double sine = norm(normal);
  return sine > 0 && std::isfinite(sine) ? normal * (1 / sine) : Vec3d{};
}

double area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  double size = 0;
  const Vec3d normal = scaled_normal(a, b, c, size);
  return size > 0 ? 0.5 * norm(normal) * size * size : size;
}

}  // namespace supple::viewer
