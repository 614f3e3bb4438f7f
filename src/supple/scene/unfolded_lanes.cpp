#include "scene/unfolded_lanes.hpp"

#include <bit>

namespace supple {

void UnfoldedLanes::update(std::uint64_t version, const ObjectOctree& octree,
                           std::span<const Triangle> triangles, const VertexBuffer& start,
                           const VertexBuffer& end, const Parallel& parallel) {
  constexpr std::uint32_t rest_steps = 15, least_share = 8;
  if (version == version_) return;
  version_ = version;
  if (steps_to_rest_ > 0) {
    --steps_to_rest_;
    return;
  }
  if (culling_.masks().empty()) culling_ = SelfCollisionCulling(octree, triangles);
  culling_.refit(octree, triangles, start, end, parallel);
  culled_version_ = version;
  std::size_t lanes = 0, unfolded = 0;
  for (std::size_t node = 0; node < octree.nodes().size(); ++node) {
    lanes += octree.nodes()[node].lane_count;
    unfolded += static_cast<std::size_t>(std::popcount(culling_.masks()[node]));
  }
  const bool pays = unfolded * least_share >= lanes;
  has_paid_ = has_paid_ || pays;
  if (!pays) steps_to_rest_ = rest_steps;
}

}  // namespace supple
