#include "queries/ray_line.hpp"

#include <cmath>

#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/wide_integer.hpp"

namespace supple {

RayLine::RayLine(const Ray& ray, const Vec3d& near) : near_(near), direction_(ray.direction) {
  const BitRange places(std::array{near.x, near.y, near.z, ray.origin.x, ray.origin.y, ray.origin.z});
  const BitRange directions(std::array{ray.direction.x, ray.direction.y, ray.direction.z});
  std::array<UnboundedInteger, 3> way, along;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    way[i] = to_integer<UnboundedInteger>(near[axis], places.lowest) -
             to_integer<UnboundedInteger>(ray.origin[axis], places.lowest);
    along[i] = to_integer<UnboundedInteger>(ray.direction[axis], directions.lowest);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>((axis + 1) % 3), k = static_cast<std::size_t>((axis + 2) % 3);
    const UnboundedInteger moment = way[i] * along[k] - way[k] * along[i];
    moment_[axis] = approximate(moment, places.lowest + directions.lowest);
  }
}

bool RayLine::misses(const QueryBox& box) const {
  for (int axis = 0; axis < 3; ++axis) {
    const int i = (axis + 1) % 3, k = (axis + 2) % 3;
    // The range of (p - origin) x direction for the points p of the box, with more than all roundings.
    double low = moment_[axis], high = low, size = std::fabs(low);
    const auto add = [&](double from, double to, double factor) {
      const double p = from * factor, q = to * factor;
      low += p < q ? p : q;
      high += p < q ? q : p;
      size += std::fabs(p) + std::fabs(q);
    };
    add(box.min[i] - near_[i], box.max[i] - near_[i], direction_[k]);
    add(box.min[k] - near_[k], box.max[k] - near_[k], -direction_[i]);
    const double slack = 0x1p-48 * size + 0x1p-1060;
    if (low > slack || high < -slack) return true;
  }
  return false;
}

}  // namespace supple
