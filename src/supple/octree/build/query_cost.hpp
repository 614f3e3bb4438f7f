#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "geometry/aabb.hpp"
#include "octree/octree_node.hpp"

namespace supple {

/// The expected cost of a query whose box meets the object's, in visits of children, by the surface-area
/// heuristic: a query that meets a box of surface R meets a box of surface S inside of it with probability
/// S / R. (Goldsmith and Salmon, "Automatic creation of object hierarchies for ray tracing", 1987.) A leaf
/// costs a visit, and an eighth for each of its triangles. Moving or scaling the object does not change the
/// cost.
///
/// `surface` is that of the object, `surface_of(node, child)` that of a child, in the same unit. 0 when the
/// object has no surface or one that is too large for double. O(nodes). The same number on every machine.
template <class SurfaceOf>
double query_cost(std::span<const OctreeNode> nodes, double surface, const SurfaceOf& surface_of) {
  constexpr double visits_per_triangle = 0.125;
  double sum = 0;
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    for (int i = 0; i < nodes[n].child_count; ++i) {
      const double visits = nodes[n].is_inner(i) ? 1 : 1 + visits_per_triangle * nodes[n].size(i);
      sum += visits * surface_of(n, i);
    }
  }
  const double cost = sum / surface;
  return std::isfinite(cost) ? cost : 0;
}

/// The same by the surfaces of the boxes.
inline double query_cost(std::span<const OctreeNode> nodes, const ChildBoxes* boxes) {
  if (nodes.empty()) return 0;
  return query_cost(nodes, half_surface(enclosing_box(boxes[0])),
                    [&](std::uint32_t n, int i) { return half_surface(child_box(boxes[n], i)); });
}

}  // namespace supple
