#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "answers/detection.hpp"
#include "supple/inspection.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

/// Reads a search of a world from the inside; `SceneInspector` documents the functions.
class Inspection {
 public:
  /// `is_current`: whether the world is as it was searched.
  Inspection(const World& world, const Detection& detection, const DetectResult& result, bool is_current)
      : world_(world), detection_(detection), result_(result), is_current_(is_current) {}

  std::vector<OctreeCell> octree_cells(ObjectId id, std::optional<std::uint32_t> level) const;
  OctreeCell leaf(ObjectId id, std::uint32_t triangle) const;
  NodePairList node_pairs(ObjectId id_a, ObjectId id_b) const;
  std::uint32_t octree_depth(ObjectId id) const;
  CandidateList candidates(std::size_t limit) const;
  PairExplanation explain(ObjectId id_a, std::uint32_t triangle_a, ObjectId id_b,
                          std::uint32_t triangle_b) const;

 private:
  const Question& question() const { return detection_.question(); }
  std::span<const ContactJob> jobs() const { return detection_.pairs().jobs(); }
  std::span<const ObjectPair> pairs() const { return detection_.pairs().pairs(); }
  double reach_of(const ContactJob& job) const {
    return reach_of_margins(world_[job.a].options.margin, world_[job.b].options.margin);
  }
  /// Throws an error unless the object is as in the search.
  const WorldObject& refitted_object(ObjectId id, const char* call) const;
  /// The pair as the narrow phase sees it, without self-collision culling.
  ObjectPairView search_view(const ContactJob& job) const;
  PairExplanation explain_in_order(const ContactJob& job, TrianglePair triangles) const;
  bool are_joined(const ContactJob& job, TrianglePair triangles) const;

  const World& world_;
  const Detection& detection_;
  const DetectResult& result_;
  bool is_current_;
};

}  // namespace supple
