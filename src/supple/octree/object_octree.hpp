#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "octree/box_kernels.hpp"
#include "octree/octree_node.hpp"
#include "octree/subtrees.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/types.hpp"

namespace supple {

/// What the kernels read of the triangles and of their vertices; `inert` may be empty.
TriangleArrays arrays_of(std::span<const Triangle> triangles, const VertexBuffer& vertices,
                         std::span<const std::uint8_t> inert);

/// Regular octree over the triangles of one object: built once, top-down, from the rest pose; its volumes
/// refitted whenever the object deforms.
///
/// Every triangle is in the one octant that holds the centre of its box. An octant with all triangles of its
/// parent is not a node of its own: the parent shrinks to it, so each inner node has two lanes at least and a
/// stray vertex far away costs one level. Nodes lie level by level. Triangles and vertices are renumbered in
/// octree order, so that a refit streams through memory. A tree of arity 4 or 2 has quarters or halves for
/// octants and leaves lanes empty.
///
/// Memory besides the positions: 240 bytes a node, 16 a triangle, 8 a vertex; 128 a node more with spheres.
class ObjectOctree {
 public:
  /// O(n log n). Non-finite vertices are allowed; their triangles count as lying in the first octant.
  ObjectOctree(const PositionsView<double>& rest_positions, std::span<const Triangle> triangles,
               const ObjectOctreeOptions& options, BoundingVolume bounding_volume, SphereFit sphere_fit);

  std::span<const OctreeNode> nodes() const { return nodes_; }
  /// First node of each level, then the number of nodes.
  std::span<const std::uint32_t> level_begin() const { return level_begin_; }
  /// Of nodes that `refresh` was called for since a lazy refit.
  const AabbLanes* boxes() const { return boxes_.data(); }
  /// Null unless the bounding volume is the sphere.
  const SphereLanes* spheres() const { return spheres_.empty() ? nullptr : spheres_.data(); }

  /// Octree order; the ids are octree vertices.
  std::span<const Triangle> triangles() const { return triangles_; }
  /// Octree triangle to the user's.
  std::span<const std::uint32_t> triangle_ids() const { return triangle_ids_; }
  /// Octree vertex to the user's, and back.
  std::span<const std::uint32_t> vertex_ids() const { return vertex_ids_; }
  std::span<const std::uint32_t> vertex_order() const { return vertex_order_; }

  /// Recomputes all volumes, bottom-up, in O(n); spheres fitted to vertices take O(n · levels).
  /// `inert` has a byte a triangle (octree order), or is empty: triangles to leave out.
  void refit(const VertexBuffer& vertices, std::span<const std::uint8_t> inert, const Parallel& parallel);

  /// The same for boxes of objects without inert triangles, as far as no query has to ask: the box of the
  /// whole object and of the top nodes' lanes, in one pass over the vertices. The others are those of
  /// `vertices` when `refresh` is called. Rounded outward once, boxes of doubles may be tighter by an ulp.
  void refit_lazily(const VertexBuffer& vertices, const Parallel& parallel);
  /// Brings the boxes of a node up to date that is reached from the root, all nodes on the way having been
  /// refreshed. Threads may call it at once.
  void refresh(std::uint32_t node, const TriangleArrays& arrays) const {
    const std::uint32_t subtree = subtrees_.of_root(node);
    if (subtree != Subtree::none && subtree_states_[subtree].load(std::memory_order_acquire) != is_fresh) {
      refresh_subtree(subtree, arrays);
    }
  }

  /// Volumes of the whole object after a refit; empty when it has no finite triangle.
  const Aabb& box() const { return box_; }
  const BoundingSphere& sphere() const { return sphere_; }

  /// The empty string when every invariant holds and every volume encloses its triangles; else what is wrong.
  /// Spheres fitted to boxes do not enclose and are not checked for it. Refreshes all nodes.
  std::string validate(const VertexBuffer& vertices, std::span<const std::uint8_t> inert) const;
  OctreeStatistics statistics() const;

 private:
  void refit_level(std::uint32_t level, const VertexBuffer& vertices, std::span<const std::uint8_t> inert,
                   const Parallel& parallel);

  void refresh_subtree(std::uint32_t subtree, const TriangleArrays& arrays) const;
  void fetch_ahead(std::uint32_t subtree, const TriangleArrays& arrays) const;
  void refit_subtree(std::uint32_t root, const TriangleArrays& arrays) const;

  enum SubtreeState : std::uint8_t { is_fresh, is_stale, in_work };

  std::vector<OctreeNode> nodes_;
  mutable std::vector<AabbLanes> boxes_;  // those of stale subtrees are brought up to date when asked for
  Subtrees subtrees_;
  std::unique_ptr<std::atomic<std::uint8_t>[]> subtree_states_;
  std::vector<SphereLanes> spheres_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> triangle_ids_, vertex_ids_, vertex_order_;
  std::vector<std::uint32_t> level_begin_;
  SphereFit sphere_fit_;
  std::uint32_t arity_;
  Aabb box_;
  BoundingSphere sphere_;
};

}  // namespace supple
