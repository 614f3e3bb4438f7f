#pragma once

#include <cstdint>
#include <span>

#include "octree/object_octree.hpp"
#include "octree/quality.hpp"
#include "supple/inspection.hpp"

namespace supple {

/// When to build degraded parts of an object's octree anew: once queries have cost as much too much as
/// building costs, so that all together never cost more than twice what would have been best, whatever
/// follows. The unit of `waste` and of prices is a query of the octree as built.
class RebuildPolicy {
 public:
  /// What the object against itself counts.
  static constexpr double queries_of_self = 8;

  explicit RebuildPolicy(bool is_allowed) : is_allowed_(is_allowed) {}

  /// The boxes are those that the octree was built from: later ones are compared with them.
  void set_references(const TreeBoxes& tree) { quality_.set_references(tree); }
  /// The octree was refitted. Its quality is measured now and then.
  void after_refit(const TreeBoxes& tree);
  /// Parts of the octree, as of the last measurement, are worth building anew: if queries come often enough.
  bool is_degraded() const { return quality_.share() > 0; }
  std::span<const std::uint32_t> degraded_nodes() const { return quality_.degraded(); }
  std::uint64_t degraded_triangles(const ObjectOctree& octree) const;
  /// Adds the number of queries of the whole octree in a step. Returns whether it is time to rebuild.
  bool count_queries(double queries);
  /// Call after the degraded parts were rebuilt, with the `old_nodes` of `ObjectOctree::rebuild`. Returns
  /// whether the result is so much better than the present tree that it should replace it.
  bool accept(const TreeBoxes& rebuilt, std::span<const std::uint32_t> old_nodes, const TreeBoxes& present,
              bool is_smooth);

  /// Cost and degradation of the tree as it is; see `OctreeStatistics`.
  void report(const TreeBoxes& tree, OctreeStatistics& statistics) const;
  std::size_t bytes() const { return quality_.bytes(); }

 private:
  double price() const;

  bool is_allowed_;
  TreeQuality quality_;
  std::uint32_t refits_until_measured_ = 1, refits_to_watch_ = 0, random_ = 0;
  double waste_ = 0;     // since the last try
  double patience_ = 2;  // waste over price at which to build; doubled each time that it did not help
};

}  // namespace supple
