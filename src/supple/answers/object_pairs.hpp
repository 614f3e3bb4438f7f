#pragma once

#include <span>
#include <vector>

#include "answers/question.hpp"
#include "broad_phase/pair_finder.hpp"
#include "world/world.hpp"

namespace supple {

/// How far the volume of an object must grow on all sides, so that it overlaps each volume that grew like it
/// where elements of the two objects are of interest. `ways` are null but for a safe step.
double growth_of(const ObjectOptions& object, const VertexWays* ways, const Question& question);

/// The broad phase of one search over a world: the pairs of objects whose volumes overlap, and what the
/// narrow phase tests. It keeps the volumes between searches, so a search tests only what changed.
class ObjectPairs {
 public:
  explicit ObjectPairs(const World& world) : ObjectPairs(world, world.options.bounding_volume) {}
  ObjectPairs(const World& world, BoundingVolume volume);

  /// Call it after `World::refit`. `ways` are those of all slots, for a safe step.
  void find(const Question& question, std::span<const VertexWays> ways = {});

  /// In canonical order.
  std::span<const ObjectPair> pairs() const { return pairs_; }
  /// These pairs and the objects with self-collision, in canonical order.
  std::span<const ContactJob> jobs() const { return jobs_; }
  /// By slot: the boxes that the broad phase compared, which may enclose motion, separation and margin.
  std::span<const Aabb> boxes() const { return boxes_; }
  const PairFinder& finder() const { return finder_; }
  /// Calls `visit(list)` for each list of the result.
  template <class Visit>
  void visit_lists(const Visit& visit) {
    visit(pairs_);
  }

 private:
  void list_volumes(const Question& question, std::span<const VertexWays> ways);
  bool are_apart(const IndexPair& pair) const;

  const World& world_;
  BoundingVolume volume_;
  PairFinder finder_;
  std::vector<ObjectPair> pairs_;
  std::vector<ContactJob> jobs_;
  // By slot.
  std::vector<Aabb> boxes_;
  std::vector<BoundingSphere> spheres_;
  SearchedShapes searched_;
};

}  // namespace supple
