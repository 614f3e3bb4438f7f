#include <algorithm>
#include <cmath>

#include "geometry/vector.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {
namespace {

/// Twice the area vector of the triangle after its sides are divided by `size`, the largest component of two
/// sides. Without the division, products of very small or large sides would underflow or overflow. Returns
/// zero when `size` is 0 or not finite.
Vec3d scaled_normal(const TrianglePoints& triangle, double& size) {
  const Vec3d ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  size = std::max(largest_magnitude(ab), largest_magnitude(ac));
  if (!(size > 0) || !std::isfinite(size)) return {};
  return cross(ab * (1 / size), ac * (1 / size));
}

}  // namespace

Vec3d unit_normal(const TrianglePoints& triangle) {
  double size = 0;
  const Vec3d normal = scaled_normal(triangle, size);
  const double sine = norm(normal);
  return sine > 0 && std::isfinite(sine) ? normal * (1 / sine) : Vec3d{};
}

double area(const TrianglePoints& triangle) {
  double size = 0;
  const Vec3d normal = scaled_normal(triangle, size);
  return size > 0 ? 0.5 * norm(normal) * size * size : size;
}

}  // namespace supple
