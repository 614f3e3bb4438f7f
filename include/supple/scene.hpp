#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/inspection.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/types.hpp"

namespace supple {

/// Rigid placement: `rotation` (row-major, may also scale or shear) and then `translation`. A point p goes to
/// fl(R p) + t, each row of R p summed from left to right in double without fused multiply-add.
struct RigidTransform {
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec3d translation{};
};

/// Many deforming objects, and every contact between them.
///
/// ```cpp
/// supple::Scene scene;
/// auto rabbit = scene.add(supple::load_mesh("rabbit.obj"));
/// auto fish = scene.add(fish_mesh, {.self_collision = true});
/// for (;;) {
///   scene.set_positions(rabbit, rabbit_xyz);
///   scene.set_positions(fish, fish_xyz);
///   for (const supple::Contact& c : scene.detect().contacts) respond(c);
/// }
/// ```
///
/// Moving an object is one call; its octree, its bounds and the scene follow at the next `detect`. The scene
/// keeps one copy of each object's positions, in the precision they were last given in (none of those it
/// shares), a second copy of objects moved by `set_transform` or `set_motion`, and one or two more once
/// continuous contacts are asked for. Calls on one scene must not overlap;
/// different scenes are independent. Every call that takes an `ObjectId` throws `Error` when the object is
/// not in the scene.
class Scene {
 public:
  /// Throws `Error` when an option is out of its range.
  explicit Scene(const SceneOptions& options = {});
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Adds an object; the octree is built from these positions (the rest pose) in O(n). An empty mesh is an
  /// object that touches nothing. Throws `Error` for a triangle that uses a vertex out of range.
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& options = {});
  ObjectId add(PositionsView<double> positions, std::span<const Triangle> triangles,
               const ObjectOptions& options = {});
  ObjectId add(PositionsView<float> positions, std::span<const Triangle> triangles,
               const ObjectOptions& options = {});
  /// Its pairs end at the next `detect`.
  void remove(ObjectId object);

  /// New positions of all vertices, the user's numbering: any stride, or packed x y z. They are copied, in
  /// O(n). Throws `Error` when the count differs from the mesh's or the object is static.
  void set_positions(ObjectId object, PositionsView<double> positions);
  void set_positions(ObjectId object, PositionsView<float> positions);
  void set_positions(ObjectId object, std::span<const double> xyz);
  void set_positions(ObjectId object, std::span<const float> xyz);
  void set_positions(ObjectId object, std::span<const Vec3d> positions) {
    set_positions(object, PositionsView<double>(positions));
  }
  void set_positions(ObjectId object, std::span<const Vec3f> positions) {
    set_positions(object, PositionsView<float>(positions));
  }
  /// As `set_positions`, but nothing is copied: the scene reads the positions where they are, from now on
  /// until the object is given others or removed. They must stay there that long, and keep their values until
  /// they are to move: then change them between calls on the scene and call this again (what reads them in
  /// between sees half of the change). Copied all the same, as by `set_positions`, when the stride is not a
  /// multiple of the scalar's size. O(1). A search for continuous contacts makes a copy of its own.
  void share_positions(ObjectId object, PositionsView<double> positions);
  void share_positions(ObjectId object, PositionsView<float> positions);
  /// Moves the object as it is by `offset`, in O(1): the vertices are not read. Each coordinate becomes
  /// fl(position + D) in double, D being the sum of the offsets since the last `set_positions`.
  void translate(ObjectId object, Vec3d offset);
  /// Places the positions last given by `add` or `set_positions`; replaces earlier transforms and
  /// translations. O(1) when only the translation changes, O(n) otherwise.
  void set_transform(ObjectId object, const RigidTransform& transform);
  /// Gives the object a path for continuous contacts: every vertex goes straight from its place in `from`
  /// (t = 0) to its place in `to` (t = 1). Any stride, or packed x y z; both are copied, in O(n). It holds
  /// until the object is moved otherwise: all other calls place it at rest. Everything but continuous
  /// contacts sees the object where the path ends. Throws `Error` as `set_positions` does.
  void set_motion(ObjectId object, PositionsView<double> from, PositionsView<double> to);
  void set_motion(ObjectId object, PositionsView<float> from, PositionsView<float> to);
  void set_motion(ObjectId object, std::span<const double> from, std::span<const double> to);
  void set_motion(ObjectId object, std::span<const float> from, std::span<const float> to);
  void set_motion(ObjectId object, std::span<const Vec3d> from, std::span<const Vec3d> to) {
    set_motion(object, PositionsView<double>(from), PositionsView<double>(to));
  }
  void set_motion(ObjectId object, std::span<const Vec3f> from, std::span<const Vec3f> to) {
    set_motion(object, PositionsView<float>(from), PositionsView<float>(to));
  }
  void set_static(ObjectId object, bool is_static);

  void set_group(ObjectId object, std::uint32_t group, std::uint32_t mask);
  void set_self_collision(ObjectId object, bool enabled);
  /// An empty function removes the filter.
  void set_pair_filter(PairFilter filter);

  /// Every contact at the current positions, within the step, or both, as the scene's options or the request
  /// ask for. Throws `Error` when the request is out of range.
  const DetectResult& detect(const DetectRequest& request = {});
  /// The first of all continuous contacts by `SceneOptions::impact`, of those at the same time the first in
  /// order; nothing when nothing touches within the step. Whatever can only touch later than what was found
  /// is passed over, so that it takes a part of the time of `detect` where much touches. `result` and
  /// `verify` stay what they were.
  std::optional<ContinuousContact> earliest_impact();
  /// The part of the step, 0 to 1, that can be taken without passing through anything: the time of
  /// `earliest_impact`, 1 when there is none. Never later than the true first contact.
  double max_step();
  /// What the last `detect` returned.
  const DetectResult& result() const;
  /// Recomputes the last `detect`, all kinds that it was asked for, by exact arithmetic alone over all pairs
  /// of triangles or elements, without octrees or filters, and lists every difference. Quadratic, but under a
  /// second for two meshes of 70,000 triangles. It reads the positions where they are: throws `Error` when
  /// anything was changed since, and when the last `detect` was stopped, truncated or asked for no contacts.
  VerifyReport verify() const;
  /// Checks every invariant of every octree and of the broad phase; the empty string, or what is wrong.
  std::string validate() const;

  /// To look into the last `detect`: each of the next three throws `Error` when something was changed since
  /// (of `octree_cells`, the object was moved), or an id is out of range. They take memory and one thread.
  ///
  /// The cells of an object's octree at `level`, and shallower leaves too, so that together they cover the
  /// object; without a level all leaves. Shallow ones first. Their volumes hold the triangles where they are
  /// now, rounded outward; those without a finite triangle are empty. Of continuous contacts they are those
  /// at the end of the step, and cells of few triangles count as leaves, as the search takes them.
  std::vector<OctreeCell> octree_cells(ObjectId object, std::optional<std::uint32_t> level) const;
  /// The deepest level that has cells; 0 of an object without triangles, which has no cell.
  std::uint32_t octree_depth(ObjectId object) const;
  /// All pairs of triangles that the narrow phase hands to the exact stage, sorted; the first `limit` of
  /// them, and in `total`, when it is not null, how many there are. Also those that `detect` need not look
  /// at: of two objects that both are where they were, and in the smooth parts of an object that cannot touch
  /// themselves. Of continuous contacts, triangles whose boxes meet on the way, by a bound that is not below
  /// `ImpactOptions::min_separation`; pairs that share a vertex are left out there too, though elements of
  /// them are tested. As fast as a `detect` by one thread; memory is of the order of `limit`.
  std::vector<CandidatePair> candidates(std::size_t limit, std::uint64_t* total = nullptr) const;
  /// Why two triangles are a contact of the last `detect`, or which stage told them apart. Calls the pair
  /// filter. O(n) of the objects' triangles; of continuous contacts also of the contacts of the two.
  PairExplanation explain(ObjectId object_a, std::uint32_t triangle_a, ObjectId object_b,
                          std::uint32_t triangle_b) const;

  std::vector<ObjectId> objects() const;  ///< ascending
  bool contains(ObjectId object) const;
  const std::string& name(ObjectId object) const;
  std::size_t vertex_count(ObjectId object) const;
  std::size_t triangle_count(ObjectId object) const;
  /// As the exact tests see it: transforms and translations applied.
  Vec3d position(ObjectId object, std::uint32_t vertex) const;
  /// Bounds as of the last `detect`; empty when nothing finite is there.
  Aabb bounds(ObjectId object) const;
  OctreeStatistics octree_statistics(ObjectId object) const;
  /// Regions of the scene octree, root first; empty for other broad phases.
  std::vector<SceneRegion> scene_regions() const;
  const SceneOptions& options() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
