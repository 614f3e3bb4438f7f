#include "octree/volumes/way_boxes.hpp"
#include "octree/object_octree.hpp"

#include <cmath>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

void set_child_box(ChildBoxes& boxes, int child, const Aabb& box) {
  boxes.min_x[child] = box.min.x;
  boxes.min_y[child] = box.min.y;
  boxes.min_z[child] = box.min.z;
  boxes.max_x[child] = box.max.x;
  boxes.max_y[child] = box.max.y;
  boxes.max_z[child] = box.max.z;
}

/// The difference is rounded, too.
Aabb box_of_way(const Vec3d& way) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    const double slack = 0x1p-50 * std::fabs(way[axis]);
    box.min[axis] = round_down(way[axis] - slack);
    box.max[axis] = round_up(way[axis] + slack);
  }
  return box;
}

}  // namespace

void set_way_boxes(const ObjectOctree& octree, const SurfaceElements& elements, const VertexBuffer& start,
                   const VertexBuffer& end, std::vector<ChildBoxes>& ways) {
  const std::span<const OctreeNode> nodes = octree.nodes();
  ways.resize(nodes.size());
  for (std::size_t n = nodes.size(); n-- > 0;) {
    const OctreeNode& node = nodes[n];
    for (int child = 0; child < node_width; ++child) {
      Aabb box;
      if (child < node.child_count && node.is_inner(child)) {
        box = enclosing_box(ways[node.child_node(child)]);
      } else if (child < node.child_count) {
        for (std::uint32_t t = node.first_triangle[child]; t < node.first_triangle[child + 1]; ++t) {
          for (const std::uint32_t vertex : elements.faces()[t]) {
            const Vec3d from = start[vertex], to = end[vertex];
            if (is_finite(from) && is_finite(to)) extend(box, box_of_way(to - from));
          }
        }
      }
      set_child_box(ways[n], child, box);
    }
  }
}

}  // namespace supple
