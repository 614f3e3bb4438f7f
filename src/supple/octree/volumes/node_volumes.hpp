#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/node_pair.hpp"
#include "octree/octree_node.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/types.hpp"

namespace supple {

/// Whether the search tests volumes of this kind where boxes overlap.
constexpr bool is_tested_after_boxes(BoundingVolume kind) {
  return kind != BoundingVolume::aabb && kind != BoundingVolume::sphere;
}

/// An octree whose boxes are refitted, for `NodeVolumes`; borrowed.
struct RefittedOctree {
  std::span<const OctreeNode> nodes;
  const ChildBoxes* boxes;
  std::span<const Triangle> triangles;
  LeafVertexArrays leaves;
  const VertexBuffer& vertices;
  std::span<const std::uint8_t> inert;             ///< a byte per triangle, or empty
  std::span<const std::uint32_t> unused_vertices;  ///< of no triangle; ascending
  /// False: the volumes of deeper nodes are out of date.
  bool are_nodes_current = true;
};

/// Volumes other than boxes of the nodes of one octree. The search tests spheres instead of boxes, and the
/// other kinds where boxes overlap. The core has none of them (`octree/comparison_methods.hpp`).
class NodeVolumes {
 public:
  NodeVolumes(BoundingVolume kind, std::size_t nodes)
      : kind_(kind), object_(static_cast<std::uint32_t>(nodes)) {}
  virtual ~NodeVolumes() = default;

  bool replace_boxes() const { return !is_tested_after_boxes(kind_); }
  /// The entry after the nodes: its first child is the whole object.
  std::uint32_t object() const { return object_; }

  /// Updates the volumes of the children of the nodes [begin, end) of one level, after their boxes and the
  /// nodes below. Calls for different nodes may overlap.
  virtual void refit(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) = 0;
  /// Updates the volume of the whole object, whose box is `box`.
  virtual void refit_object(const RefittedOctree& octree, const Aabb& box) = 0;

  /// Clears bit 8 i + j of `masks[k]` when child i of node a and child j of node b of `pairs[k]` are apart.
  /// Bits of children outside of the pair are unspecified. Never misses an overlap. `b` is of the same kind.
  virtual void clear_apart(std::span<const NodePair> pairs, const NodeVolumes& b,
                           const RelativePlacement& placement, std::uint64_t* masks) const = 0;

  /// A child's sphere; empty for other kinds.
  virtual BoundingSphere sphere(std::uint32_t, int) const { return {}; }
  /// A child's volume after a translation, as an intersection of slabs: the three axes of an oriented box, or
  /// those of the box and the other directions of a k-DOP. Rounded outward. Empty for other kinds.
  virtual std::vector<Slab> slabs(std::uint32_t, int, const Aabb&, Vec3d) const { return {}; }
  virtual std::size_t bytes() const = 0;

 private:
  BoundingVolume kind_;
  std::uint32_t object_;
};

}  // namespace supple
