#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "octree/box_kernels.hpp"
#include "octree/octree_node.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/inspection.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/types.hpp"

namespace supple {

/// What the kernels read of the triangles and of their vertices; `inert` may be empty.
TriangleArrays arrays_of(std::span<const Triangle> triangles, const VertexBuffer& vertices,
                         std::span<const std::uint8_t> inert);

/// Octree over the triangles of one object, built top-down from the rest pose. Its volumes are refitted when
/// the object deforms.
///
/// It is balanced (`octree/balanced_build.hpp`) or, when asked for, the paper's regular one. In that every
/// triangle is in the one octant that holds the centre of its box. An octant with all triangles of its parent
/// is not a node of its own: the parent shrinks to it, so that a stray vertex far away costs one level. A
/// regular tree of arity 4 or 2 has quarters or halves for octants and leaves lanes empty.
///
/// Each inner node has two lanes at least. Nodes lie level by level. Triangles are renumbered in octree
/// order. Leaves are large: testing dozens of triangles in vectors costs less than nodes that would tell them
/// apart, and only the triangles of leaves that a query meets are looked at.
///
/// Memory besides the positions: 272 bytes a node, 23 a triangle, 4 for each vertex of each leaf; 128 a node
/// more with spheres.
class ObjectOctree {
 public:
  /// O(n log n). Non-finite vertices are allowed; their triangles count as lying in the lower
  /// corner.
  ObjectOctree(const PositionsView& rest_positions, std::span<const Triangle> triangles,
               const ObjectOctreeOptions& options, BoundingVolume bounding_volume, SphereFit sphere_fit);

  std::span<const OctreeNode> nodes() const { return nodes_; }
  /// First node of each level, then the number of nodes.
  std::span<const std::uint32_t> level_begin() const { return level_begin_; }
  const AabbLanes* boxes() const { return boxes_.data(); }
  /// Null unless the bounding volume is the sphere.
  const SphereLanes* spheres() const { return spheres_.empty() ? nullptr : spheres_.data(); }

  LeafVertexArrays leaf_vertices() const {
    return {first_leaf_vertex_.data(), leaf_vertices_.data(), leaf_corners_.data(), leaf_corners_.size() / 3};
  }

  /// Octree order; the ids are the user's vertices.
  std::span<const Triangle> triangles() const { return triangles_; }
  /// Octree triangle to the user's.
  std::span<const std::uint32_t> triangle_ids() const { return triangle_ids_; }
  /// And back.
  std::uint32_t octree_triangle(std::uint32_t user_triangle) const { return triangle_order_[user_triangle]; }
  const Triangle& user_triangle(std::uint32_t triangle) const {
    return triangles_[octree_triangle(triangle)];
  }
  std::size_t vertex_count() const { return vertex_count_; }

  /// Recomputes all volumes, bottom-up, in O(n); spheres fitted to vertices take O(n · levels).
  /// `inert` has a byte a triangle (octree order), or is empty: triangles to leave out. Returns false, and
  /// the volumes are of no use, when it is empty and some vertex is not finite.
  bool refit(const VertexBuffer& vertices, std::span<const std::uint8_t> inert, const Parallel& parallel);

  /// The octree of the same triangles and options, built from other positions. O(n log n).
  ObjectOctree rebuilt(const PositionsView& positions) const;

  /// Volumes of the whole object after a refit; empty when it has no finite triangle.
  Aabb box() const { return nodes_.empty() ? Aabb{} : box_of_lanes(boxes_[0]); }
  const BoundingSphere& sphere() const { return sphere_; }

  /// The empty string when every invariant holds and every volume encloses its triangles; else what is wrong.
  /// Spheres fitted to boxes do not enclose and are not checked for it.
  std::string validate(const VertexBuffer& vertices, std::span<const std::uint8_t> inert) const;
  OctreeStatistics statistics() const;

 private:
  void list_leaf_vertices();
  bool refit_level(std::uint32_t level, const VertexBuffer& vertices, std::span<const std::uint8_t> inert,
                   const Parallel& parallel);
  void refit_spheres(std::uint32_t node_begin, std::uint32_t node_end, const VertexBuffer& vertices,
                     std::span<const std::uint8_t> inert);

  std::vector<OctreeNode> nodes_;
  std::vector<AabbLanes> boxes_;
  std::vector<SphereLanes> spheres_;
  std::vector<std::uint32_t> level_begin_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> triangle_ids_, triangle_order_;
  std::size_t vertex_count_;
  // As `LeafVertexArrays`, and the vertices of no triangle.
  std::vector<std::uint32_t> first_leaf_vertex_, leaf_vertices_, unused_vertices_;
  std::vector<std::uint8_t> leaf_corners_;
  ObjectOctreeOptions options_;
  SphereFit sphere_fit_;
  BoundingSphere sphere_;
};

}  // namespace supple
