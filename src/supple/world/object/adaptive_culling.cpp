#include "world/object/adaptive_culling.hpp"

#include <bit>

namespace supple {

void AdaptiveCulling::update(std::uint64_t version, const ObjectOctree& octree,
                             std::span<const Triangle> triangles, const VertexBuffer& start,
                             const VertexBuffer& end, const Parallel& parallel) {
  constexpr std::uint32_t pause = 15;  // steps
  // One child in so many must be culled. Smooth cloth culls more than half; closed bodies, of which culling
  // costs more than it saves, at most 28 % (rabbits).
  constexpr std::size_t least_share = 3;
  if (version == version_) return;
  version_ = version;
  if (steps_to_pause_ > 0) {
    --steps_to_pause_;
    return;
  }
  if (!culling_) culling_ = std::make_unique<SelfCollisionCulling>(octree, triangles);
  culling_->refit(octree, triangles, start, end, parallel);
  culled_version_ = version;
  std::size_t children = 0, culled = 0;
  for (std::size_t node = 0; node < octree.nodes().size(); ++node) {
    children += octree.nodes()[node].child_count;
    culled += static_cast<std::size_t>(std::popcount(culling_->masks()[node]));
  }
  if (culled * least_share < children) steps_to_pause_ = pause;
}

}  // namespace supple
