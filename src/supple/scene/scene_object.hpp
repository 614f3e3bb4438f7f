#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/moving_boxes.hpp"
#include "octree/object_octree.hpp"
#include "octree/quality.hpp"
#include "octree/self_collision_culling.hpp"
#include "octree/surface_elements.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/scene.hpp"

namespace supple {

/// One object of a scene: its octree, its positions and how it is placed.
///
/// A position is fl(R p) + T of the position p last given. The octree's volumes are those of fl(R p); T is
/// added where volumes and positions are read, so that translating is O(1). Where magnitudes are such that
/// this could lose bits or overflow in single precision, T is settled into the positions instead.
class SceneObject {
 public:
  SceneObject(const PositionsView& positions, std::span<const Triangle> triangles,
              const ObjectOptions& options, const SceneOptions& scene_options);

  void set_positions(const PositionsView& positions, const Parallel& parallel);
  /// The same without a copy when contacts are discrete and the layout allows it.
  void share_positions(const PositionsView& positions, const Parallel& parallel);
  void set_motion(const PositionsView& from, const PositionsView& to, const Parallel& parallel);
  void translate(Vec3d offset, const Parallel& parallel);
  void set_transform(const RigidTransform& transform, const Parallel& parallel);

  /// Whether octree or bounds lag behind the positions.
  bool is_stale() const { return needs_refit_ || needs_bounds_; }
  bool needs_refit() const { return needs_refit_; }
  /// Brings octree and bounds up to date.
  void update(const Parallel& parallel);

  /// The rest positions that the octree was built from are set: its boxes are what later ones are compared
  /// with.
  void set_rest_quality(const Parallel& parallel);
  /// Parts of the octree, as of the last update, are worth building anew: if it is asked for often enough.
  bool is_degraded() const { return quality_.share() > 0; }
  /// So many queries of the whole octree in a step; the object against itself is `queries_of_self`. Returns
  /// whether by now they have cost as much too much as building the degraded parts anew will cost: never more
  /// than twice what would have been best, whatever follows.
  bool count_queries(double queries);
  static constexpr double queries_of_self = 8;
  /// Triangles that `rebuild` is about to sort.
  std::uint64_t degraded_triangles() const;
  /// Builds the degraded parts anew from present positions; if these are much better than what is there, they
  /// take its place, and the object is brought up to date again. Views are of no use then; what is found does
  /// not change.
  void rebuild(const Parallel& parallel);
  /// Since the object was added, and their triangles.
  std::uint64_t subtrees_rebuilt() const { return subtrees_rebuilt_; }
  std::uint64_t triangles_rebuilt() const { return triangles_rebuilt_; }

  /// Of the placed object, as of the last update; with continuous contacts, around its whole motion.
  const Aabb& box() const { return box_; }
  const BoundingSphere& sphere() const { return sphere_; }
  OctreeView view() const;
  /// With continuous contacts: the path's ends, the same buffer at rest, and the boxes around them.
  const VertexBuffer& start() const { return has_motion_ ? start_ : vertices_; }
  const VertexBuffer& end() const { return vertices_; }
  OctreeView moving_view() const;
  const ObjectOctree& octree() const { return octree_; }
  /// Placed position of a vertex in octree order.
  Vec3d position(std::uint32_t octree_vertex) const;
  /// The same, or where the path starts when the coordinates that are not finite are there.
  Vec3d non_finite_position(std::uint32_t octree_vertex) const;
  /// User's numbers, ascending.
  std::span<const std::uint32_t> non_finite_vertices() const { return non_finite_; }
  std::string validate() const;
  OctreeStatistics octree_statistics() const;

  ObjectOptions options;

 private:
  Vec3d lazy_translation() const { return is_settled_ ? Vec3d{} : translation_; }
  void keep_shape();
  void apply_rotation(const Parallel& parallel);
  void unsettle(const Parallel& parallel);
  bool is_extreme() const;
  void settle(const Parallel& parallel);
  void refit_octree(const Parallel& parallel);
  void update_moving(const Parallel& parallel);
  void update_unfolded(const Parallel& parallel);
  void place_afresh();
  void mark_moved();
  void find_non_finite();
  TreeBoxes tree_boxes() const;
  std::uint32_t leaf_limit() const;
  void measure_quality();

  ObjectOctree octree_;
  VertexBuffer vertices_;  // fl(R p), or fl(R p) + T when settled
  VertexBuffer shape_;     // p, once a transform made `vertices_` differ from it
  bool has_shape_ = false;
  bool is_settled_ = false;
  std::array<double, 9> rotation_ = RigidTransform{}.rotation;
  Vec3d translation_;
  std::vector<std::uint8_t> inert_;  // as of the last update: a byte a triangle in octree order, or empty
  std::vector<std::uint32_t> non_finite_;
  // Of continuous contacts, for which the octree's own volumes are not kept up to date.
  bool is_continuous_;
  bool has_motion_ = false;
  VertexBuffer start_;
  SurfaceElements elements_;
  MovingBoxes moving_boxes_;
  // For objects that are tested against themselves.
  bool passes_over_unfolded_;
  SelfCollisionCulling unfolded_;
  bool has_unfolded_ = false;                 // of the present positions
  bool was_unfolded_ = false;                 // enough of it to be worth the search, at some time
  std::uint32_t steps_without_unfolded_ = 1;  // finding the boundaries is for objects that go on moving
  // The paper's results depend on leaves: they stay those of the rest pose.
  bool may_rebuild_;
  TreeQuality quality_;
  std::uint32_t refits_until_measured_ = 1, refits_to_watch_ = 0, random_ = 0;
  double waste_ = 0;     // of queries since the last try, in queries of the octree as built
  double patience_ = 2;  // doubled each time that building anew did not help
  std::uint64_t subtrees_rebuilt_ = 0, triangles_rebuilt_ = 0;
  bool needs_refit_ = true;
  bool needs_bounds_ = true;
  Aabb box_;
  BoundingSphere sphere_;
};

}  // namespace supple
