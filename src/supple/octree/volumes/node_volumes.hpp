#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/oriented_box.hpp"
#include "octree/octree_node.hpp"
#include "octree/vertex_buffer.hpp"
#include "octree/volumes/oriented_box_fit.hpp"
#include "octree/volumes/slab_kernels.hpp"
#include "supple/options.hpp"
#include "supple/types.hpp"

namespace supple {

/// Whether the kind is an oriented box or a k-DOP: where boxes overlap, the search tests these volumes.
constexpr bool is_tested_after_boxes(BoundingVolume kind) {
  return kind != BoundingVolume::aabb && kind != BoundingVolume::sphere;
}

/// The oriented boxes of the children of a node, one array per number.
struct alignas(64) ChildOrientedBoxes {
  float center[3][node_width];
  float axes[3][3][node_width];  ///< axis, coordinate, child
  float half_lengths[3][node_width];
};

/// The oriented boxes or k-DOPs of one octree, or neither; borrowed.
struct NodeVolumesView {
  const ChildOrientedBoxes* oriented_boxes = nullptr;
  const float* slabs = nullptr;  ///< see `floats_per_slab`
  std::span<const Vec3f> directions{};
  /// The entry after the nodes: its first child is the whole object.
  std::uint32_t object = 0;

  bool empty() const { return oriented_boxes == nullptr && slabs == nullptr; }
  const float* slabs_of(std::uint32_t node) const {
    return slabs + std::size_t{node} * directions.size() * floats_per_slab;
  }
};

/// Volumes of the nodes of one octree that are tighter than boxes: oriented boxes, or the slabs that make
/// k-DOPs of the boxes. Empty for other kinds of volumes.
class NodeVolumes {
 public:
  NodeVolumes(BoundingVolume kind, std::size_t nodes);

  /// Updates the volumes of the children of the nodes [begin, end) of one level, after their boxes and the
  /// nodes below. Slabs take O(vertices) for the whole octree, oriented boxes O(vertices · levels).
  void refit(std::span<const OctreeNode> nodes, const ChildBoxes* boxes, const SurfacePart& surface,
             const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end);
  /// Updates the volume of the whole object, after all nodes.
  void refit_object(std::span<const OctreeNode> nodes, const ChildBoxes* boxes, const SurfacePart& surface,
                    const LeafVertexArrays& leaves);

  bool empty() const { return oriented_boxes_.empty() && slabs_.empty(); }
  NodeVolumesView view() const;
  std::size_t bytes() const {
    return oriented_boxes_.capacity() * sizeof(ChildOrientedBoxes) +
           moments_.capacity() * sizeof(SurfaceMoments) + slabs_.capacity() * sizeof(float);
  }

 private:
  std::vector<ChildOrientedBoxes> oriented_boxes_;
  std::vector<SurfaceMoments> moments_;  // of the nodes
  std::vector<float> slabs_;
  std::span<const Vec3f> directions_;
};

OrientedBox child_oriented_box(const ChildOrientedBoxes& boxes, int child);

/// A child's volume where the object is now, as an intersection of slabs. The three axes of an oriented box,
/// or those of the box and the other directions of a k-DOP. Rounded outward.
std::vector<Slab> child_slabs(const NodeVolumesView& volumes, const Aabb& box, std::uint32_t node, int child,
                              Vec3d translation);

}  // namespace supple
