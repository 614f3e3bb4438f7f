#include "octree/build/query_cost.hpp"

#include <cmath>
#include <cstddef>

#include "geometry/aabb.hpp"
#include "geometry/polytope.hpp"

namespace supple {
namespace {

/// `surface_of(node, child)` is the surface of a child, `surface` that of the object, in the same unit.
template <class SurfaceOf>
double sum_of_costs(std::span<const OctreeNode> nodes, double surface, const SurfaceOf& surface_of) {
  constexpr double visits_per_triangle = 0.125;
  double sum = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (int i = 0; i < nodes[n].child_count; ++i) {
      const double visits = nodes[n].is_inner(i) ? 1 : 1 + visits_per_triangle * nodes[n].size(i);
      sum += visits * surface_of(n, i);
    }
  }
  const double cost = sum / surface;
  return std::isfinite(cost) ? cost : 0;
}

}  // namespace

double query_cost(std::span<const OctreeNode> nodes, const ChildBoxes* boxes) {
  if (nodes.empty()) return 0;
  return sum_of_costs(nodes, half_surface(enclosing_box(boxes[0])),
                      [&](std::size_t n, int i) { return half_surface(child_box(boxes[n], i)); });
}

double query_cost(std::span<const OctreeNode> nodes, const ChildSpheres* spheres,
                  const BoundingSphere& object) {
  const auto surface = [](const BoundingSphere& sphere) {
    return sphere.empty() ? 0 : double{sphere.radius} * sphere.radius;
  };
  return sum_of_costs(nodes, surface(object),
                      [&](std::size_t n, int i) { return surface(child_sphere(spheres[n], i)); });
}

double query_cost(std::span<const OctreeNode> nodes, const ChildBoxes* boxes,
                  const NodeVolumesView& volumes) {
  if (nodes.empty()) return 0;
  const auto surface = [&](std::size_t n, int child, const Aabb& box) {
    return box.empty()
               ? 0
               : Polytope(child_slabs(volumes, box, static_cast<std::uint32_t>(n), child, {})).surface();
  };
  return sum_of_costs(
      nodes, surface(volumes.object, 0, enclosing_box(boxes[0])),
      [&](std::size_t n, int child) { return surface(n, child, child_box(boxes[n], child)); });
}

}  // namespace supple
