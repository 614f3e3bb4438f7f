#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/parallel.hpp"
#include "octree/object_octree.hpp"
#include "scene/moving_shape.hpp"
#include "scene/placement.hpp"
#include "scene/rebuild_policy.hpp"
#include "scene/resting_shape.hpp"
#include "supple/inspection.hpp"
#include "supple/options.hpp"

namespace supple {

/// What a search needs of the objects.
struct SearchedShapes {
  bool resting = false, moving = false;
  /// Also which of their lanes cannot touch themselves, of objects that are tested against themselves.
  bool unfolded_resting = false, unfolded_moving = false;

  constexpr bool operator==(const SearchedShapes&) const = default;
};

/// One object of a scene: its octree, where it is, and the shapes that searches read.
class SceneObject {
 public:
  SceneObject(const PositionsView& positions, std::span<const Triangle> triangles,
              const ObjectOptions& object_options, const SceneOptions& scene_options);

  /// Whoever moves the object calls this.
  Placement& move() {
    has_moved_ = true;
    return placement_;
  }
  const Placement& placement() const { return placement_; }
  /// Since the last update.
  bool has_moved() const { return has_moved_; }
  /// Whether a shape or the volumes lag behind.
  bool is_stale(const SearchedShapes& shapes) const;
  /// Whether triangles are to be refitted, not the volumes alone.
  bool needs_refit(const SearchedShapes& shapes) const;
  /// Brings the shapes and the volumes up to date.
  void update(const SearchedShapes& shapes, const Parallel& parallel);

  /// Call when the placement has the positions that the octree was built from.
  void measure_built_octree(const Parallel& parallel);
  const RebuildPolicy& rebuild_policy() const { return rebuild_policy_; }
  RebuildPolicy& rebuild_policy() { return rebuild_policy_; }
  /// Builds an octree from the current positions. Returns whether it is so much better that it replaced the
  /// present one: then the shapes are up to date, but views are invalid. Contacts do not change.
  bool rebuild(const Parallel& parallel);

  /// The box of the placed object at the last update: around everything that was searched, which may be the
  /// whole motion.
  const Aabb& box() const { return box_; }
  const BoundingSphere& sphere() const { return sphere_; }
  const ObjectOctree& octree() const { return octree_; }
  const MovingShape& moving() const { return moving_; }
  OctreeView resting_view() const { return resting_.view(octree_, placement_); }
  OctreeView moving_view() const { return moving_.view(octree_, placement_); }
  /// User's numbers, ascending.
  std::span<const std::uint32_t> non_finite_vertices(const SearchedShapes& shapes) const {
    return shapes.moving ? moving_.non_finite_vertices() : resting_.non_finite_vertices();
  }
  /// The vertex, or where its path starts when the coordinates that are not finite are there.
  Vec3d non_finite_position(std::uint32_t vertex) const;
  /// Of those shapes that are up to date.
  std::string validate() const;
  OctreeStatistics octree_statistics() const;

  ObjectOptions options;

 private:
  void refit(const SearchedShapes& shapes, const Parallel& parallel);
  double current_query_cost() const;
  void update_volumes(const SearchedShapes& shapes);

  ObjectOctree octree_;
  Placement placement_;
  RestingShape resting_;
  MovingShape moving_;
  RebuildPolicy rebuild_policy_;
  std::uint64_t rebuilds_ = 0;
  bool has_moved_ = true;
  SearchedShapes updated_;  // by the last update
  Aabb box_;
  BoundingSphere sphere_;
};

}  // namespace supple
