#include "comparison/volumes/kdops.hpp"

namespace supple {
namespace {

std::span<const Vec3f> directions_of(BoundingVolume kind) {
  const std::span<const Vec3f> all = slab_directions;
  return kind == BoundingVolume::kdop14 ? all.first(4) : kind == BoundingVolume::kdop18 ? all.last(6) : all;
}

}  // namespace

Kdops::Kdops(BoundingVolume kind, std::size_t nodes)
    : NodeVolumes(kind, nodes),
      directions_(directions_of(kind)),
      slabs_(nodes == 0 ? 0 : offset_of(object() + 1)) {}

std::vector<Slab> Kdops::slabs(std::uint32_t node, int child, const Aabb& box, Vec3d translation) const {
  std::vector<Slab> result;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3f direction;
    direction[axis] = 1;
    result.push_back(moved_slab(direction, box.min[axis], box.max[axis], translation));
  }
  const float* low = slabs_.data() + offset_of(node) + child;
  for (const Vec3f& direction : directions_) {
    result.push_back(moved_slab(direction, low[0], low[node_width], translation));
    low += floats_per_slab;
  }
  return result;
}

}  // namespace supple
