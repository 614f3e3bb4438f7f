#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/parallel.hpp"
#include "octree/object_octree.hpp"
#include "octree/self_collision_culling.hpp"
#include "octree/vertex_buffer.hpp"

namespace supple {

/// Self-collision culling of an object that pauses for some steps when it culls too little. For crumpled
/// cloth, for example, it costs more than it saves.
class AdaptiveCulling {
 public:
  /// Culls for the positions of this version, in O(n), the first time in O(n log n). Does nothing when the
  /// version did not change.
  void update(std::uint64_t version, const ObjectOctree& octree, std::span<const Triangle> triangles,
              const VertexBuffer& start, const VertexBuffer& end, const Parallel& parallel);
  /// The masks of `SelfCollisionCulling`, or null when there are none for this version.
  const std::uint8_t* masks(std::uint64_t version) const {
    return version == culled_version_ ? culling_->masks().data() : nullptr;
  }
  std::size_t bytes() const { return culling_ ? culling_->bytes() : 0; }

  /// Call after the octree was rebuilt or edited. An object that is edited in each step is never culled.
  void forget_octree() {
    culling_.reset();
    version_ = culled_version_ = 0;
    if (steps_to_pause_ == 0) steps_to_pause_ = 1;
  }

 private:
  std::unique_ptr<SelfCollisionCulling> culling_;
  std::uint64_t version_ = 0, culled_version_ = 0;
  std::uint32_t steps_to_pause_ =
      1;  // skips the first step: boundaries pay only for objects that keep moving
};

}  // namespace supple
