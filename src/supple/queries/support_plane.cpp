#include "queries/support_plane.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/vector.hpp"

namespace supple {
namespace {

bool are_level(std::span<const Vec3d> points, int axis) {
  return std::ranges::all_of(points, [&](const Vec3d& p) { return p[axis] == points[0][axis]; });
}

/// Whether the foot of a vertex on an edge, or on another vertex, has the same place across `axis`. For a
/// slanted edge this is not clear.
bool is_foot_below(const Vec3d& vertex, std::span<const Vec3d> other, int axis) {
  int free = 0;
  for (int i = 0; i < 3; ++i) {
    if (i == axis) continue;
    if (!are_level(other, i)) {
      ++free;
    } else if (other[0][i] != vertex[i]) {
      return false;
    }
  }
  return free < 2;
}

/// The axis that is exactly parallel to the way between two features; -1 when there is none or it is not
/// clear.
int axis_of_way(const FeatureVertices& a, const FeatureVertices& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!are_level(a.all(), axis) || !are_level(b.all(), axis)) continue;
    if (a.points[0][axis] == b.points[0][axis]) continue;
    const bool is_across_plane = a.count == 3 || b.count == 3 || (a.count == 2 && b.count == 2);
    if (is_across_plane) return axis;
    const bool is_vertex_of_a = a.count == 1;
    if (is_foot_below((is_vertex_of_a ? a : b).points[0], (is_vertex_of_a ? b : a).all(), axis)) return axis;
  }
  return -1;
}

SupportPlane plane_of(const FeatureVertices& feature, const std::array<double, 3>& weights,
                      const Vec3d& normal, int axis) {
  SupportPlane plane{feature.points[0], normal, axis, {}, 0};
  for (std::size_t i = 1; i < feature.count; ++i) {
    const Vec3d to_vertex = feature.points[i] - plane.origin;
    plane.nearest += weights[i] * to_vertex;
    plane.rounding += 0x1p-47 * largest_magnitude(to_vertex);
  }
  return plane;
}

}  // namespace

std::array<SupportPlane, 2> support_planes(const FeatureVertices& a, const std::array<double, 3>& weights_a,
                                           const FeatureVertices& b, const std::array<double, 3>& weights_b,
                                           const Vec3d& normal) {
  const int axis = axis_of_way(a, b);
  Vec3d direction = normal;
  if (axis >= 0) {
    direction = {};
    direction[axis] = a.points[0][axis] > b.points[0][axis] ? 1 : -1;
  }
  return {plane_of(a, weights_a, direction, axis), plane_of(b, weights_b, -direction, axis)};
}

bool are_farther(const SupportPlane& plane_a, const QueryBox& box_a, double depth_a,
                 const SupportPlane& plane_b, const QueryBox& box_b, double depth_b, double distance) {
  const double depth = depth_a + depth_b;
  if (depth > 0) return true;
  if (!(depth_a >= 0 && depth_b >= 0) && !(depth < 0)) return false;
  double squared_gap = 0;
  for (int i = 0; i < 3; ++i) {
    const double low_a = box_a.min[i] - plane_a.origin[i], high_a = box_a.max[i] - plane_a.origin[i],
                 low_b = box_b.min[i] - plane_b.origin[i], high_b = box_b.max[i] - plane_b.origin[i];
    const double way = plane_a.nearest[i] - plane_b.nearest[i];
    const double size = std::fabs(low_a) + std::fabs(high_a) + std::fabs(low_b) + std::fabs(high_b);
    const double slack = 0x1p-48 * size + plane_a.rounding + plane_b.rounding;
    const double gap = std::max(low_a - high_b - way, way - (high_a - low_b)) - slack;
    if (gap > 0) squared_gap += gap * gap;
  }
  return squared_gap * (1 - 0x1p-40) > -2 * distance * depth + 0x1p-1000;
}

}  // namespace supple
