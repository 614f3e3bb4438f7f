#include "octree/volumes/way_boxes.hpp"
#include "octree/object_octree.hpp"

#include <cmath>
#include <limits>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/refit_bottom_up.hpp"

namespace supple {

void set_way_boxes(const ObjectOctree& octree, const SurfaceElements& elements, const VertexBuffer& start,
                   const VertexBuffer& end, std::vector<ChildBoxes>& ways) {
  ways.resize(octree.nodes().size());
  refit_child_boxes(octree.nodes(), ways.data(), [&](const OctreeNode& node, int child) {
    constexpr double far = std::numeric_limits<double>::infinity();
    Vec3d most{-far, -far, -far}, most_back = most;
    for (const Triangle& face : elements.faces().subspan(node.first_triangle[child], node.size(child))) {
      for (const std::uint32_t vertex : face) {
        const Vec3d from = start[vertex], to = end[vertex];
        if (!is_finite(from) || !is_finite(to)) continue;
        most = larger(most, to - from);
        most_back = larger(most_back, from - to);
      }
    }
    Aabb box;
    for (int axis = 0; axis < 3 && most.x > -far; ++axis) {
      // The differences are rounded, too.
      box.min[axis] = round_down(-most_back[axis] - 0x1p-50 * std::fabs(most_back[axis]));
      box.max[axis] = round_up(most[axis] + 0x1p-50 * std::fabs(most[axis]));
    }
    return box;
  });
}

}  // namespace supple
