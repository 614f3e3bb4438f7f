#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "answers/penetration/manifold_methods.hpp"
#include "answers/question.hpp"
#include "core/kept_lists.hpp"
#include "scene/pair_cache.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

/// What begins, stays and ends from one step of a scene to the next: pairs of objects and manifolds.
class Events {
 public:
  /// Throws `Error` when the question asks for manifolds that this process does not make.
  void start(const Question& question);
  /// Compares the answers of a step with those of the step before, and measures the time of manifolds. It
  /// does everything that may run out of memory, and the state stays that of the step before until `publish`.
  void prepare(World& world, const Question& question, DetectResult& found);
  /// Takes the step over, and adds its events and manifolds to `found`. Each pair begins and ends exactly
  /// once.
  void publish(DetectResult& found);

  /// Keeps each list to which `publish` adds spans.
  void keep(KeptLists& kept);

  /// Call it before `release`; this may run out of memory.
  void prepare_release();
  /// The object is removed: its pairs end at the next step.
  void release(ObjectId id);

 private:
  static constexpr std::size_t of_leaves = events_of_kinds, of_volumes = of_leaves + 1;

  void list_pairs(const DetectResult& found);

  /// By `place_of_events`, then those of colliding vertices and of object pairs.
  std::array<PairCache, of_volumes + 1> events_;
  std::unique_ptr<ManifoldMaker> manifolds_;               // null until a step asks for manifolds
  std::array<std::vector<ObjectPair>, of_volumes> pairs_;  // those of a step
};

}  // namespace supple
