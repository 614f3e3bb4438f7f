#include "inspect/octree_statistics.hpp"

#include <algorithm>

#include "inspect/polytope.hpp"
#include "octree/build/query_cost.hpp"

namespace supple {

OctreeStatistics octree_statistics(const ObjectOctree& octree) {
  OctreeStatistics result;
  result.triangles = octree.triangles().size();
  result.vertices = octree.vertex_count();
  result.nodes = octree.nodes().size();
  std::uint64_t children = 0;
  for (const OctreeNode& node : octree.nodes()) {
    children += node.child_count;
    for (int child = 0; child < node.child_count; ++child) {
      if (node.is_inner(child)) continue;
      // An object of one leaf is that leaf: the root itself, not an octant of it.
      const std::uint32_t level = node.child_count == 1 ? 0 : node.level + 1u;
      if (level >= result.leaves_by_level.size()) result.leaves_by_level.resize(level + 1);
      ++result.leaves_by_level[level];
      ++result.leaves;
      result.depth = std::max(result.depth, level);
      result.largest_leaf =
          std::max(result.largest_leaf, node.first_triangle[child + 1] - node.first_triangle[child]);
    }
  }
  if (result.leaves > 0) {
    result.mean_leaf_size = static_cast<double>(result.triangles) / static_cast<double>(result.leaves);
    result.mean_node_width = static_cast<double>(children) / static_cast<double>(result.nodes);
  }
  return result;
}

double cost_of_volumes(const ObjectOctree& octree) {
  const NodeVolumes& volumes = *octree.volumes();
  const auto surface = [&](std::uint32_t n, int child, const Aabb& box) -> double {
    const BoundingSphere sphere = volumes.sphere(n, child);
    if (volumes.replace_boxes()) return sphere.empty() ? 0 : double{sphere.radius} * sphere.radius;
    return box.empty() ? 0 : Polytope(volumes.slabs(n, child, box, {})).surface();
  };
  if (octree.nodes().empty()) return 0;
  return query_cost(
      octree.nodes(), surface(volumes.object(), 0, enclosing_box(octree.boxes()[0])),
      [&](std::uint32_t n, int child) { return surface(n, child, child_box(octree.boxes()[n], child)); });
}

OctreeStatistics octree_statistics(const WorldObject& object) {
  const ObjectOctree& octree = object.octree();
  OctreeStatistics result = octree_statistics(octree);
  result.bytes = object.bytes();
  if (result.triangles > 0) {
    result.bytes_per_triangle = static_cast<double>(result.bytes) / static_cast<double>(result.triangles);
  }
  result.cost = object.current_query_cost();
  result.degradation = object.rebuild_policy().degradation(result.cost);
  if (octree.volumes() != nullptr && object.is_resting_current()) result.cost = cost_of_volumes(octree);
  result.rebuilds = object.rebuilds();
  return result;
}

}  // namespace supple
