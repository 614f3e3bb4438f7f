#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "supple/broad_phase.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/scene.hpp"
#include "supple/views.hpp"
#include "world/object/world_object.hpp"

namespace supple {

/// Two objects to test against each other, as indices into the slots of a world; a <= b. Both are equal for a
/// self-collision test.
struct ContactJob {
  std::uint32_t a = 0, b = 0;

  constexpr auto operator<=>(const ContactJob&) const = default;
};

/// The objects of a scene, where they are now, their octrees, and which of them may touch. It knows no
/// contacts and no events: any number of searches can run over one world.
///
/// Each object has a slot; a slot without an object is free for the next one. Functions that take an
/// `ObjectId` throw an error that names `call` when the object is not in the world.
class World {
 public:
  explicit World(const SceneOptions& scene_options);

  ObjectId add(const PositionsView& positions, const TrianglesView& triangles,
               const ObjectOptions& object_options, const std::string& fallback_name);
  /// When memory runs out, it throws before it changes anything.
  void remove(ObjectId id);

  /// Gives the objects of these slots, which are all objects, the slots 0, 1 and so on. Ids change, and
  /// searches take all objects as moved.
  void arrange(std::span<const std::uint32_t> slots);

  bool contains(ObjectId id) const;
  std::vector<ObjectId> objects() const;
  WorldObject& object(ObjectId id, const char* call) const;
  std::size_t slot_count() const { return slots_.size(); }
  /// Null for a free slot.
  WorldObject* at(std::size_t slot) const { return slots_[slot].object.get(); }
  WorldObject& operator[](std::size_t slot) const { return *slots_[slot].object; }
  ObjectId id_of(std::uint32_t slot) const { return {slot, slots_[slot].generation}; }
  /// Both objects, the smaller id first; throws an error when they are the same.
  ObjectPair two_objects(ObjectId a, ObjectId b, const char* call) const;

  /// The bounds, if any, are finite.
  void set_positions(ObjectId id, const PositionsView& positions,
                     const std::optional<std::array<Vec3d, 2>>& bounds = {});
  void set_vertices(ObjectId id, std::span<const std::uint32_t> vertices, const PositionsView& positions);
  void share_positions(ObjectId id, const PositionsView& positions);
  void edit(ObjectId id, const MeshEdit& edit);
  std::vector<std::uint32_t> compact(ObjectId id);
  void translate(ObjectId id, const Vec3d& offset);
  void set_transform(ObjectId id, const RigidTransform& transform);
  void set_motion(ObjectId id, const PositionsView& from, const PositionsView& to);
  void set_options(ObjectId id, const ObjectChanges& changes);
  void set_vertex_groups(ObjectId id, std::span<const std::uint32_t> groups,
                         std::span<const std::uint32_t> masks);
  void set_filter(PairFilter filter);

  /// Increases with each change of what a search may find.
  std::uint64_t changes() const { return changes_; }
  /// By slot: numbers of positions. Each is used once. They are those of the last refit.
  std::span<const std::uint64_t> versions() const { return versions_; }

  bool has_filter() const { return filter_ != nullptr; }
  bool may_pair(const IndexPair& pair) const;
  /// Without the pair filter.
  bool may_pair_by_groups(const IndexPair& pair) const;
  /// All pairs of objects that may collide, and the objects with self-collision, whatever their volumes.
  std::vector<ObjectPair> all_pairs() const;

  /// Numbers of objects and of their triangles.
  struct Work {
    std::uint64_t objects = 0, triangles = 0;
  };
  /// Refits the objects that have moved, and those that lack one of the shapes.
  Work refit(const SearchedShapes& shapes);
  /// Rebuilds degraded octrees where that pays, some in each call: the others wait. `jobs` are those of the
  /// search; jobs of objects that did not move search nothing. `boxes` are those of the slots. Views of
  /// rebuilt octrees are invalid afterwards.
  Work rebuild_degraded(std::span<const ContactJob> jobs, std::span<const Aabb> boxes);

  const SceneOptions options;
  const Parallel parallel;

 private:
  struct Slot {
    std::unique_ptr<WorldObject> object;
    std::uint32_t generation = 0;
  };

  /// As `object`; also throws an error when the object is static.
  WorldObject& movable_object(ObjectId id, const char* call) const;
  void mark_changed() { ++changes_; }
  template <class Size, class Function>
  void for_each_object(std::span<const std::uint32_t> slots, const Size& size, const Function& function);
  void count_queries(std::span<const ContactJob> jobs, std::span<const Aabb> boxes);
  Work rebuild_those_that_pay(std::span<const ContactJob> jobs, std::span<const Aabb> boxes);

  const Parallel serial_{1};
  PairFilter filter_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_slots_;
  std::uint64_t changes_ = 1;
  std::vector<std::uint64_t> versions_;
  std::uint64_t last_version_ = 0,
                counted_version_ = 0;  // the newest, and the newest when queries of octrees were counted
  std::vector<std::uint32_t> stale_, degraded_, small_;  // scratch memory
  std::vector<double> queries_;                          // of degraded objects
};

/// Which options got other values.
struct ChangedOptions {
  bool distances = false;  ///< the margin or the minimum separation
  bool pairs = false;      ///< which objects may touch
};
/// Gives the options the new values, after a check of them.
ChangedOptions change_options(ObjectOptions& options, const ObjectChanges& changes);

/// Throws an error that names `call` when the object has no such vertex or triangle.
void check_vertex(const WorldObject& object, std::uint32_t vertex, const char* call);
void check_triangle(const WorldObject& object, std::uint32_t triangle, const char* call);

}  // namespace supple
