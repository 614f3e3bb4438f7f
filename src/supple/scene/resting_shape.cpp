#include "scene/resting_shape.hpp"

#include "geometry/vector.hpp"

namespace supple {

void mark_inert(const ObjectOctree& octree, const VertexBuffer& vertices, std::vector<std::uint8_t>& inert) {
  inert.assign(octree.triangles().size(), 0);
  for (std::uint32_t t = 0; t < inert.size(); ++t) {
    for (const std::uint32_t vertex : octree.triangles()[t]) inert[t] |= !is_finite(vertices[vertex]);
  }
}

void RestingShape::update(ObjectOctree& octree, Placement& placement, const Parallel& parallel) {
  if (!is_current(placement)) refit(octree, placement, parallel);
  if (!placement.needs_baking(octree.box())) return;
  placement.bake(parallel);
  refit(octree, placement, parallel);
}

void RestingShape::refit(ObjectOctree& octree, const Placement& placement, const Parallel& parallel) {
  inert_.clear();
  non_finite_.clear();
  if (!octree.refit(placement.end(), {}, parallel)) {
    mark_inert(octree, placement.end(), inert_);
    for (std::uint32_t vertex = 0; vertex < octree.vertex_count(); ++vertex) {
      if (!is_finite(placement.position(vertex))) non_finite_.push_back(vertex);
    }
    octree.refit(placement.end(), inert_, parallel);
  }
  version_ = placement.version();
}

OctreeView RestingShape::view(const ObjectOctree& octree, const Placement& placement) const {
  OctreeView view = view_of(octree, placement.end(), inert_, placement.translation());
  view.culled = culling_.masks(placement.version());
  return view;
}

}  // namespace supple
