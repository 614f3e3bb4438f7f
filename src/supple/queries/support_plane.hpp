#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "supple/contact.hpp"
#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {

/// The vertices of a feature, in the order of its barycentric coordinates.
struct FeatureVertices {
  std::array<Vec3d, 3> points{};
  std::size_t count = 0;

  std::span<const Vec3d> all() const { return {points.data(), count}; }
};

/// The plane through the nearest point of a surface so far, across the way to the nearest point of another
/// one. Where two points are behind the planes of both surfaces, they are not nearer to each other. This
/// prunes where distances cannot: the depth of a point behind its plane has an error that is small with
/// respect to the surface, however far the other one is.
struct SupportPlane {
  Vec3d origin;  ///< a vertex of the feature that holds the nearest point: exact, and in the plane
  Vec3d normal;  ///< unit vector away from the other surface, rounded
  /// The axis of the normal when the exact one is parallel to it, else -1.
  int axis = -1;
  Vec3d nearest;        ///< the nearest point, from `origin`, rounded
  double rounding = 0;  ///< more than its error

  /// At most how far the point or the box is behind the plane. A depth of 0 is exact at `origin`, and
  /// everywhere when the normal is an axis.
  double depth(const Vec3d& p) const { return depth(QueryBox{p, p}); }
  double depth(const QueryBox& box) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const double low = depth_along(box.min[i] - origin[i], i),
                   high = depth_along(box.max[i] - origin[i], i);
      sum += low < high ? low : high;
    }
    // Products may underflow, also to 0, unless the normal is an axis.
    const bool is_exact = axis >= 0 || (sum == 0 && box.min == origin && box.max == origin);
    return is_exact ? sum : sum - 0x1p-1060;
  }

 private:
  /// With more than the roundings of the difference, the normal and the sum. For infinite differences, -inf.
  double depth_along(double difference, int i) const {
    if (axis >= 0 && i != axis) return 0;
    const double slack = 0x1p-48 * (difference < 0 ? -difference : difference);
    const double result = difference * normal[i] - slack;
    return result == result ? result : -slack;
  }
};

/// The planes of two surfaces from their nearest features, whose nearest points are inside both. `normal` is
/// the direction from b to a.
std::array<SupportPlane, 2> support_planes(const FeatureVertices& a, const std::array<double, 3>& weights_a,
                                           const FeatureVertices& b, const std::array<double, 3>& weights_b,
                                           const Vec3d& normal);

/// Whether what is in two boxes of these depths is certainly farther apart than `distance`, that of the
/// nearest points. With d the way between these and e the difference to it, the squared distance exceeds d²
/// by e² + 2 d·e, and d·e is |d| times the sum of the depths.
bool are_farther(const SupportPlane& plane_a, const QueryBox& box_a, double depth_a,
                 const SupportPlane& plane_b, const QueryBox& box_b, double depth_b, double distance);

}  // namespace supple
