#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "geometry/vector.hpp"
#include "scene/scene_implementation.hpp"

namespace supple {
namespace {

constexpr std::array<double, 3> centre{1.0 / 3, 1.0 / 3, 1.0 / 3};

/// The barycentric coordinates of a point in a triangle, at least 0; those of the centre when it is flat.
std::array<double, 3> barycentric_of(const Vec3d& point, const std::array<Vec3d, 3>& corners) {
  std::array rows{corners[1] - corners[0], corners[2] - corners[0], point - corners[0]};
  double largest = 0;
  for (const Vec3d& row : rows) largest = std::max(largest, largest_magnitude(row));
  if (!(largest > 0 && std::isfinite(largest))) return centre;
  const int exponent = -std::ilogb(largest);
  for (Vec3d& row : rows) {
    for (int axis = 0; axis < 3; ++axis) row[axis] = std::ldexp(row[axis], exponent);
  }
  const auto& [u, v, p] = rows;
  const Vec3d normal = cross(u, v);
  const double area = dot(normal, normal);
  if (!(area > 0)) return centre;
  const double second = std::clamp(dot(cross(p, v), normal) / area, 0.0, 1.0);
  const double third = std::clamp(dot(cross(u, p), normal) / area, 0.0, 1 - second);
  return {1 - second - third, second, third};
}

}  // namespace

detail::PairWeights detail::weights_of(const Scene& scene, const Contact& contact) {
  const std::span<const ContactPoint> all = scene.result().contact_points;
  if (all.empty()) return {centre, centre};
  if (contact.point_count == 0 || contact.first_point + std::size_t{contact.point_count} > all.size())
    fail("for_each_vertex: the contact has no points in the result; take one of the last detect");
  Vec3d mean;
  for (const ContactPoint& point : all.subspan(contact.first_point, contact.point_count))
    mean += point.position / static_cast<double>(contact.point_count);
  const auto weights = [&](ContactSide side) {
    const bool is_a = side == ContactSide::a;
    const ElementVertices vertices = scene.vertices_of(contact, side);
    std::array<Vec3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i)
      corners[i] = scene.position(is_a ? contact.object_a : contact.object_b, vertices[i]);
    return barycentric_of(mean, corners);
  };
  return {weights(ContactSide::a), weights(ContactSide::b)};
}

}  // namespace supple
