#include "scene/scene_object.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// The ball around a box.
BoundingSphere sphere_around(const Aabb& box) {
  if (box.empty()) return {};
  BoundingSphere sphere;
  double squared_radius = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    sphere.center[axis] = static_cast<float>((low + high) / 2);
    const double reach = std::max(high - sphere.center[axis], sphere.center[axis] - low);
    squared_radius += reach * reach;
  }
  sphere.radius = round_up(std::sqrt(squared_radius) * (1 + 0x1p-50));
  return sphere;
}

/// The rule for the size of leaves. All vertices, edges and faces of two leaves are tested for continuous
/// contacts, most of them in vain: leaves half as large are faster. A regular octree stays what was asked
/// for.
ObjectOctreeOptions octree_options(const ObjectOptions& options, const SceneOptions& scene_options) {
  ObjectOctreeOptions octree = options.octree;
  if (contains(scene_options.contacts, ContactKinds::continuous) && !octree.regular && octree.arity == 8)
    octree.leaf_size = octree.leaf_size / 2 + octree.leaf_size % 2;
  return octree;
}

}  // namespace

SceneObject::SceneObject(const PositionsView& positions, std::span<const Triangle> triangles,
                         const ObjectOptions& object_options, const SceneOptions& scene_options)
    : options(object_options),
      octree_(positions, triangles, octree_options(object_options, scene_options),
              scene_options.bounding_volume, scene_options.comparison.sphere_fit),
      // The paper's results depend on leaves: they stay those of the rest pose.
      rebuild_policy_(object_options.octree.rebuild_degraded &&
                      !scene_options.comparison.colliding_vertices &&
                      scene_options.comparison.sphere_fit == SphereFit::vertices) {}

bool SceneObject::is_stale(const SearchedShapes& shapes) const {
  return has_moved_ || shapes != updated_ || needs_refit(shapes);
}

bool SceneObject::needs_refit(const SearchedShapes& shapes) const {
  return (shapes.resting && !resting_.is_current(placement_)) ||
         (shapes.moving && !moving_.is_current(placement_));
}

void SceneObject::update(const SearchedShapes& shapes, const Parallel& parallel) {
  const bool was_behind = needs_refit(shapes);
  refit(shapes, parallel);
  update_volumes(shapes);
  if (was_behind) rebuild_policy_.after_refit(tree_boxes());
  has_moved_ = false;
  updated_ = shapes;
}

/// A shape that is up to date stays so.
void SceneObject::refit(const SearchedShapes& shapes, const Parallel& parallel) {
  SearchedShapes wanted = shapes;
  wanted.resting = wanted.resting || resting_.is_current(placement_);
  wanted.moving = wanted.moving || moving_.is_current(placement_);
  // A shape that bakes the translation leaves the other one behind.
  do {
    if (wanted.resting) resting_.update(octree_, placement_, parallel);
    if (wanted.moving) moving_.update(octree_, placement_, parallel);
  } while (needs_refit(wanted));
  if (!options.self_collision) return;
  if (wanted.unfolded_resting) resting_.update_unfolded(octree_, placement_, parallel);
  if (wanted.unfolded_moving) moving_.update_unfolded(octree_, parallel);
}

void SceneObject::update_volumes(const SearchedShapes& shapes) {
  if (!shapes.moving) {
    box_ = moved(octree_.box(), placement_.translation());
    sphere_ = moved(octree_.sphere(), placement_.translation());
    return;
  }
  box_ = moving_.box();
  if (shapes.resting) extend(box_, octree_.box());
  box_ = moved(box_, placement_.translation());
  sphere_ = sphere_around(box_);
}

/// A shape that is up to date, if any is.
TreeBoxes SceneObject::tree_boxes() const {
  const bool of_moving = !resting_.is_current(placement_) && moving_.is_current(placement_);
  return {octree_.nodes(), of_moving ? moving_.node_boxes() : octree_.boxes()};
}

void SceneObject::set_rest_quality(const Parallel& parallel) {
  resting_.update(octree_, placement_, parallel);
  rebuild_policy_.set_references(tree_boxes());
}

void SceneObject::rebuild(const Parallel& parallel) {
  ObjectOctree octree = octree_;
  const std::vector<std::uint32_t> old_nodes =
      octree.rebuild(rebuild_policy_.degraded_nodes(), placement_.end());
  if (!octree.refit(placement_.end(), {}, parallel)) {
    std::vector<std::uint8_t> inert;
    mark_inert(octree, placement_.end(), inert);
    octree.refit(placement_.end(), inert, parallel);
  }
  const std::uint64_t subtrees = rebuild_policy_.degraded_nodes().size();
  const std::uint64_t triangles = rebuild_policy_.degraded_triangles(octree_);
  const bool is_smooth = resting_.unfolded().has_paid() || moving_.unfolded().has_paid();
  if (!rebuild_policy_.accept({octree.nodes(), octree.boxes()}, old_nodes, tree_boxes(), is_smooth)) return;
  subtrees_rebuilt_ += subtrees;
  triangles_rebuilt_ += triangles;
  SearchedShapes shapes = updated_;
  shapes.resting = shapes.resting || resting_.is_current(placement_);
  shapes.moving = shapes.moving || moving_.is_current(placement_);
  octree_ = std::move(octree);
  resting_.forget_octree();
  moving_.forget_octree();
  // The memory for this may be lacking: then the next update makes good what is missing.
  refit(shapes, parallel);
}

std::string SceneObject::validate() const {
  if (resting_.is_current(placement_)) {
    if (std::string wrong = resting_.validate(octree_, placement_); !wrong.empty()) return wrong;
  }
  return moving_.is_current(placement_) ? moving_.validate(octree_) : "";
}

OctreeStatistics SceneObject::octree_statistics() const {
  OctreeStatistics statistics = octree_.statistics();
  statistics.bytes += resting_.bytes() + moving_.bytes() + rebuild_policy_.bytes();
  rebuild_policy_.report(tree_boxes(), statistics);
  statistics.subtrees_rebuilt = subtrees_rebuilt_;
  statistics.triangles_rebuilt = triangles_rebuilt_;
  if (statistics.triangles != 0) {
    statistics.bytes_per_triangle =
        static_cast<double>(statistics.bytes) / static_cast<double>(statistics.triangles);
  }
  return statistics;
}

Vec3d SceneObject::non_finite_position(std::uint32_t vertex) const {
  const Vec3d end = placement_.position(vertex);
  return is_finite(end) ? placement_.start_position(vertex) : end;
}

}  // namespace supple
