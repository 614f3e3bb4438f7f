#include "octree/query_cost.hpp"

#include <cmath>
#include <cstddef>

#include "geometry/aabb.hpp"

namespace supple {

double query_cost(std::span<const OctreeNode> nodes, const ChildBoxes* boxes) {
  constexpr double visits_per_triangle = 0.125;
  if (nodes.empty()) return 0;
  double sum = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (int i = 0; i < nodes[n].child_count; ++i) {
      const double visits = nodes[n].is_inner(i) ? 1 : 1 + visits_per_triangle * nodes[n].size(i);
      sum += visits * half_surface(child_box(boxes[n], i));
    }
  }
  const double cost = sum / half_surface(enclosing_box(boxes[0]));
  return std::isfinite(cost) ? cost : 0;
}

}  // namespace supple
