#include "comparison/volumes/medial_axis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "comparison/volumes/volume_kernels.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// No vertex is nearer to the centre than this factor of the radius. A factor of 1 would read all vertices of
/// a round part for each of its triangles, because all balls below it touch them.
constexpr double empty_part = 0.9;

/// A ball that touches a point and lies in a direction, of length 1.
struct ShrinkingBall {
  const RefittedOctree& octree;
  Vec3d point, direction;
  double radius;

  /// Shrinks the ball, still touching the point, until the vertices below a node are outside.
  void shrink(std::uint32_t n) {
    const OctreeNode& node = octree.nodes[n];
    for (int child = 0; child < node.child_count; ++child) {
      const Vec3d center = point + radius * direction;
      const Aabb box = child_box(octree.boxes[n], child);
      const Vec3d gap = larger(larger(in_double(box.min) - center, center - in_double(box.max)), {});
      if (!(norm(gap) < empty_part * radius)) continue;
      if (node.is_inner(child))
        shrink(node.child_node(child));
      else
        for_each_vertex(octree, n, child, [&](std::uint32_t vertex) { exclude(octree.vertices[vertex]); });
    }
  }

  void exclude(const Vec3d& vertex) {
    const double twice_height = 2 * dot(vertex - point, direction), square = squared_norm(vertex - point);
    if (square < twice_height * radius) radius = square / twice_height;
  }
};

/// The centroid of a triangle, and its normal, as long as twice the area.
std::pair<Vec3d, Vec3d> plane_of(const RefittedOctree& octree, std::uint32_t triangle) {
  const auto& [a, b, c] = octree.triangles[triangle];
  const Vec3d p = octree.vertices[a], q = octree.vertices[b], r = octree.vertices[c];
  return {(p + q + r) / 3, cross(q - p, r - p)};
}

}  // namespace

Vec3d MedialCenter::position(const RefittedOctree& octree) const {
  const auto [centroid, normal] = plane_of(octree, triangle);
  return centroid - depth / std::sqrt(norm(normal)) * normal;
}

std::vector<double> medial_depths(const RefittedOctree& octree) {
  const Aabb box = enclosing_box(octree.boxes[0]);
  // No ball in a closed object is larger; the limit is for boxes that are not finite.
  const double largest =
      std::min(norm(in_double(box.max) - in_double(box.min)) / 2, double{std::numeric_limits<float>::max()});
  std::vector<double> depths(octree.triangles.size());
  for (std::uint32_t t = 0; t < depths.size(); ++t) {
    const auto [centroid, normal] = plane_of(octree, t);
    const Vec3d direction = -normalized(normal);
    if (!is_finite(centroid + direction) || direction == Vec3d{}) continue;
    ShrinkingBall ball{octree, centroid, direction, largest};
    ball.shrink(0);
    depths[t] = ball.radius / std::sqrt(norm(normal));
  }
  return depths;
}

}  // namespace supple
