#include "world/object/resting_shape.hpp"

#include <optional>

#include "geometry/vector.hpp"

namespace supple {

bool mark_inert(const ObjectOctree& octree, const VertexBuffer& vertices, std::uint32_t face_count,
                std::vector<std::uint8_t>& inert) {
  inert.assign(octree.triangles().size(), 0);
  bool are_faces = false;
  for (std::uint32_t t = 0; t < inert.size(); ++t) {
    for (const std::uint32_t vertex : octree.triangles()[t]) inert[t] |= !is_finite(vertices[vertex]);
    const bool is_face = octree.triangle_ids()[t] < face_count;
    are_faces = are_faces || (is_face && inert[t] != 0);
    inert[t] |= !is_face;
  }
  return are_faces;
}

std::size_t RestingShape::update(ObjectOctree& octree, Placement& placement, const Parallel& parallel) {
  std::size_t refitted = 0;
  if (!is_current(placement)) refitted = refit(octree, placement, parallel);
  if (!placement.needs_baking(octree.box())) return refitted;
  placement.bake(parallel);
  return refit(octree, placement, parallel);
}

std::size_t RestingShape::update_object(ObjectOctree& octree, Placement& placement,
                                        const std::optional<Aabb>& box, const Parallel& parallel) {
  if (octree.id_count() != face_count_) return update(octree, placement, parallel);
  while (!has_object(placement)) {
    version_ = 0;
    if (!comparison_methods({}).refit_object(octree, placement.end(), box))
      return update(octree, placement, parallel);
    inert_.clear();
    non_finite_.clear();
    has_inert_faces_ = false;
    object_version_ = placement.version();
    placement.forget_moved();
    if (!placement.needs_baking(octree.box())) continue;
    placement.bake(parallel);
    // The given box is that of the positions before.
    return update_object(octree, placement, std::nullopt, parallel);
  }
  return 0;
}

std::size_t RestingShape::refit(ObjectOctree& octree, Placement& placement, const Parallel& parallel) {
  const auto moved = placement.moved_since(version_);
  std::optional<std::size_t> refitted;
  // With inert triangles, a vertex that becomes finite can change more than the triangles around it.
  if (moved && inert_.empty() && non_finite_.empty())
    refitted = octree.refit_moved(placement.end(), *moved, parallel);
  if (!refitted) {
    refit_all(octree, placement, parallel);
    refitted = octree.triangles().size();
  }
  version_ = placement.version();
  placement.forget_moved();
  return *refitted;
}

void RestingShape::refit_all(ObjectOctree& octree, const Placement& placement, const Parallel& parallel) {
  version_ = object_version_ = 0;  // until all is refitted, also when memory runs out on the way
  inert_.clear();
  non_finite_.clear();
  has_inert_faces_ = false;
  const bool are_finite = octree.refit(placement.end(), {}, parallel);
  if (are_finite && octree.id_count() == face_count_) return;
  has_inert_faces_ = mark_inert(octree, placement.end(), face_count_, inert_);
  const auto is_finite_at = [&](std::uint32_t v) { return is_finite(placement.position(v)); };
  if (!are_finite) list_non_finite(octree, is_finite_at, non_finite_);
  octree.refit(placement.end(), inert_, parallel);
}

OctreeView RestingShape::view(const ObjectOctree& octree, const Placement& placement) const {
  OctreeView view = view_of(octree, placement.end(), inert_, placement.translation());
  view.culled = culling_.masks(placement.version());
  return view;
}

}  // namespace supple
