#include "world/object/moving_shape.hpp"

#include "geometry/vector.hpp"
#include "world/object/resting_shape.hpp"

namespace supple {

void MovingShape::update(const ObjectOctree& octree, Placement& placement, const Parallel& parallel) {
  if (!is_current(placement)) refit(octree, placement, parallel);
  if (!placement.needs_baking(box())) return;
  placement.bake(parallel);
  refit(octree, placement, parallel);
}

void MovingShape::refit(const ObjectOctree& octree, const Placement& placement, const Parallel& parallel) {
  if (elements_.vertex_ids().size() != octree.vertex_count()) elements_ = SurfaceElements(octree);
  end_.gather(placement.end(), elements_.vertex_ids(), parallel);
  if (has_way(placement)) start_.gather(placement.start(), elements_.vertex_ids(), parallel);
  non_finite_.clear();
  if (!boxes_.refit(octree, elements_, has_way(placement) ? start_ : end_, end_, parallel)) {
    const auto is_finite_at = [&](std::uint32_t v) {
      return is_finite(placement.position(v)) &&
             (!has_way(placement) || is_finite(placement.start_position(v)));
    };
    list_non_finite(octree, is_finite_at, non_finite_);
  }
  version_ = placement.version();
}

OctreeView MovingShape::view(const ObjectOctree& octree, const Placement& placement) const {
  OctreeView view = moving_view_of(octree, elements_, boxes_, placement.translation());
  view.culled = culling_.masks(placement.version());
  return view;
}

std::size_t MovingShape::bytes() const {
  return elements_.bytes() + start_.bytes() + end_.bytes() + boxes_.bytes() + culling_.bytes();
}

}  // namespace supple
