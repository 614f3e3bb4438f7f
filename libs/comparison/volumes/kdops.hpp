#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "comparison/volumes/volume_kernels.hpp"
#include "octree/volumes/node_volumes.hpp"

namespace supple {

/// The slabs that make k-DOPs of the boxes. A refit takes O(vertices).
class Kdops final : public NodeVolumes {
 public:
  Kdops(BoundingVolume kind, std::size_t nodes);

  void refit(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) override {
    refit_slabs(octree, directions_, slabs_.data(), begin, end);
  }
  void refit_object(const RefittedOctree& octree, const Aabb&) override {
    unite_slabs(slabs_.data(), octree.nodes[0].child_count, directions_.size(),
                slabs_.data() + offset_of(object()), 0);
  }
  void clear_apart(std::span<const NodePair> pairs, const NodeVolumes& b, const RelativePlacement& placement,
                   std::uint64_t* masks) const override {
    clear_slabs_apart(pairs, directions_, slabs_.data(), static_cast<const Kdops&>(b).slabs_.data(),
                      placement, masks);
  }
  std::vector<Slab> slabs(std::uint32_t node, int child, const Aabb& box, Vec3d translation) const override;
  std::size_t bytes() const override { return slabs_.capacity() * sizeof(float); }

 private:
  std::size_t offset_of(std::uint32_t node) const { return node * directions_.size() * floats_per_slab; }

  std::span<const Vec3f> directions_;
  std::vector<float> slabs_;  // see `floats_per_slab`
};

}  // namespace supple
