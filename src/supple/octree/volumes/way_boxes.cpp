#include "octree/volumes/way_boxes.hpp"
#include "octree/object_octree.hpp"

#include <cmath>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/refit_bottom_up.hpp"

namespace supple {
namespace {

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
  ways.resize(octree.nodes().size());
  refit_child_boxes(octree.nodes(), ways.data(), [&](const OctreeNode& node, int child) {
    Aabb box;
    for (const Triangle& face : elements.faces().subspan(node.first_triangle[child], node.size(child))) {
      for (const std::uint32_t vertex : face) {
        const Vec3d from = start[vertex], to = end[vertex];
        if (is_finite(from) && is_finite(to)) extend(box, box_of_way(to - from));
      }
    }
    return box;
  });
}

}  // namespace supple
