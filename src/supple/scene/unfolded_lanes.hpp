#pragma once

#include <cstdint>
#include <span>

#include "core/parallel.hpp"
#include "octree/object_octree.hpp"
#include "octree/self_collision_culling.hpp"
#include "octree/vertex_buffer.hpp"

namespace supple {

/// Self-collision culling of an object in motion. Where it culls too little, as in crumpled cloth, it costs
/// more than it saves and pauses for some steps.
class UnfoldedLanes {
 public:
  /// Updates for the positions of this version; O(n), and O(n log n) the first time. Does nothing when the
  /// version did not change.
  void update(std::uint64_t version, const ObjectOctree& octree, std::span<const Triangle> triangles,
              const VertexBuffer& start, const VertexBuffer& end, const Parallel& parallel);
  /// Masks of a `SelfCollisionCulling`, or null when there are none for this version.
  const std::uint8_t* masks(std::uint64_t version) const {
    return version == culled_version_ ? culling_.masks().data() : nullptr;
  }
  /// Whether enough of the object was culled, at some time, to be worth the search.
  bool has_paid() const { return has_paid_; }
  std::size_t bytes() const { return culling_.bytes(); }

  /// Call after the octree was rebuilt.
  void forget_octree() {
    culling_ = {};
    version_ = culled_version_ = 0;
  }

 private:
  SelfCollisionCulling culling_;
  std::uint64_t version_ = 0, culled_version_ = 0;
  bool has_paid_ = false;
  std::uint32_t steps_to_rest_ = 1;  // finding the boundaries is for objects that go on moving
};

}  // namespace supple
