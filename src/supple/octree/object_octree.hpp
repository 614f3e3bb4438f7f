#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "octree/octree_node.hpp"
#include "octree/vertex_buffer.hpp"
#include "octree/volumes/box_kernels.hpp"
#include "octree/volumes/node_volumes.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/types.hpp"

namespace supple {

constexpr std::uint32_t no_place = ~std::uint32_t{0};

/// Raw arrays for the kernels; `inert` may be empty.
TriangleArrays arrays_of(std::span<const Triangle> triangles, const VertexBuffer& vertices,
                         std::span<const std::uint8_t> inert);

/// Octree over the triangles of one object, built from the rest pose. `refit` updates its volumes when the
/// object deforms.
///
/// It is built balanced (`octree/build/balanced_build.hpp`), or regular or bottom-up by supple::comparison.
/// In a regular octree, each triangle is in the octant that contains the centre of its box. A node whose
/// triangles are all in one octant shrinks to that octant, so that a single vertex far away costs one level.
/// With arity 4 or 2, nodes have quarters or halves instead of octants, and the other children are missing.
///
/// Each node below the root has at least two children. Nodes are stored level by level. Triangles are
/// renumbered in octree order. Leaves are large: testing dozens of triangles with vector instructions costs
/// less than the nodes that would separate them.
///
/// Memory besides the positions: 272 bytes per node, 23 per triangle, 4 for each vertex of each leaf; with
/// spheres 128 more per node (`SphereFit::medial`: 256), with oriented boxes 592, with k-DOPs 32 (k - 6).
class ObjectOctree {
 public:
  /// O(n log n). Triangles with a vertex that is not finite count as the lower corner of the others. `ids`
  /// are the user's ids of the triangles, ascending and smaller than `id_count`; by default 0, 1 and so on.
  ObjectOctree(const PositionsView& rest_positions, std::span<const Triangle> triangles,
               const ObjectOctreeOptions& options, BoundingVolume bounding_volume, SphereFit sphere_fit,
               const Parallel& parallel = Parallel(1), std::span<const std::uint32_t> ids = {},
               std::size_t id_count = 0);

  std::span<const OctreeNode> nodes() const { return nodes_; }
  /// `OctreeTopology::numbers`.
  std::span<const std::uint64_t> cell_numbers() const { return cell_numbers_; }
  const ChildBoxes* boxes() const { return boxes_.data(); }
  /// Null when the bounding volume is the box.
  const NodeVolumes* volumes() const { return volumes_.get(); }

  LeafVertexArrays leaf_vertices() const {
    return {first_leaf_vertex_.data(), leaf_vertices_.data(), leaf_corners_.data(), triangles_.size(),
            leaf_vertices_.size() - first_leaf_vertex_.back()};
  }

  /// The triangles in octree order, with the user's vertex ids.
  std::span<const Triangle> triangles() const { return triangles_; }
  /// The user's id of each triangle in octree order.
  std::span<const std::uint32_t> triangle_ids() const { return triangle_ids_; }
  /// The place of the user's triangle in octree order.
  std::uint32_t octree_triangle(std::uint32_t user_triangle) const { return triangle_order_[user_triangle]; }
  const Triangle& user_triangle(std::uint32_t triangle) const {
    return triangles_[octree_triangle(triangle)];
  }
  /// The user's ids are smaller than this; those of removed triangles stay unused.
  std::size_t id_count() const { return triangle_order_.size(); }
  bool has_triangle(std::uint32_t user_triangle) const {
    return user_triangle < triangle_order_.size() && triangle_order_[user_triangle] != no_place;
  }
  std::size_t vertex_count() const { return vertex_count_; }

  /// Calls `body(begin, end)` with ranges of nodes of at least about `grain`: level by level, the deepest
  /// first, in parallel within a level.
  template <class Body>
  void for_nodes_bottom_up(const Parallel& parallel, std::size_t grain, const Body& body) const {
    for (std::size_t level = level_begin_.size() - 1; level-- > 0;) {
      const std::uint32_t first = level_begin_[level];
      parallel.for_ranges(
          level_begin_[level + 1] - first, grain, [&](std::size_t begin, std::size_t end, std::uint32_t) {
            body(static_cast<std::uint32_t>(first + begin), static_cast<std::uint32_t>(first + end));
          });
    }
  }

  /// Computes all volumes bottom-up in O(n); spheres fitted to vertices take O(n · levels). `inert` has a
  /// byte per triangle in octree order, not 0 for triangles to leave out, or is empty. Returns false when it
  /// is empty and a vertex of a triangle is not finite; then the volumes are invalid.
  bool refit(const VertexBuffer& vertices, std::span<const std::uint8_t> inert, const Parallel& parallel);

  /// As `refit` without inert triangles, when only the vertices `moved` have changed since the last refit,
  /// which succeeded without inert triangles. Computes only the nodes with a leaf that contains such a
  /// vertex, and the nodes above them; the volumes have the same bits as those of `refit`. Returns the number
  /// of triangles in leaves of these nodes, or nothing when a vertex is not finite; then the volumes are
  /// invalid.
  ///
  /// O(k log n) for k vertices. The first call takes O(n), and memory: 4 bytes a vertex and 4 for each vertex
  /// of each leaf.
  std::optional<std::size_t> refit_moved(const VertexBuffer& vertices, std::span<const std::uint32_t> moved,
                                         const Parallel& parallel);

  /// Triangles with their ids, ascending.
  struct Triangles {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> ids;

    void push(const Triangle& triangle, std::size_t id) {
      triangles.push_back(triangle);
      ids.push_back(static_cast<std::uint32_t>(id));
    }
  };
  /// Those of the octree without some, ascending.
  Triangles listed_triangles(std::span<const std::uint32_t> without = {}) const;
  /// An octree with the same options of other triangles, whose ids are smaller than `id_count`.
  ObjectOctree built_like_this(const PositionsView& positions, const Triangles& listed, std::size_t id_count,
                               const Parallel& parallel) const {
    return ObjectOctree(positions, listed.triangles, options_, bounding_volume_, sphere_fit_, parallel,
                        listed.ids, id_count);
  }
  /// The octree of the same triangles and options, built from other positions. O(n log n).
  ObjectOctree rebuilt(const PositionsView& positions, const Parallel& parallel = Parallel(1)) const {
    return built_like_this(positions, listed_triangles(), id_count(), parallel);
  }

  /// Removes triangles, by the user's ids, ascending, and adds some, whose ids follow `id_count`. Builds
  /// again, from these positions, the smallest subtrees that hold them, but subtrees of a few times their
  /// number; `is_local` is false for octrees that can only be built as a whole. The boxes are invalid until
  /// the next `refit`. Takes all memory before it changes anything. O(k log n) for k triangles, and copies
  /// of the arrays.
  void edit(std::span<const std::uint32_t> removed, std::span<const Triangle> added,
            const PositionsView& positions, bool is_local, const Parallel& parallel);

  /// Volumes of the whole object at the last refit; empty when it has no finite triangle.
  const Aabb& box() const { return box_; }
  BoundingSphere sphere() const {
    return volumes_ ? volumes_->sphere(volumes_->object(), 0) : BoundingSphere{};
  }

  const ObjectOctreeOptions& options() const { return options_; }
  /// Spheres fitted to boxes need not enclose their triangles.
  bool spheres_enclose() const {
    return bounding_volume_ == BoundingVolume::sphere && sphere_fit_ != SphereFit::box;
  }
  /// Memory without that of the positions.
  std::size_t bytes() const;

 private:
  friend struct LazyRefit;  // of the library supple::comparison

  struct EditedSubtree;

  void list_leaf_vertices(const Parallel& parallel);
  void list_unused_vertices();
  std::vector<EditedSubtree> subtrees_to_edit(std::span<const std::uint32_t> removed,
                                              std::span<const Triangle> added,
                                              const PositionsView& positions) const;
  std::uint32_t lowest_node_with(std::uint32_t triangle) const;
  std::uint32_t lowest_node_near(const Vec3d& point) const;
  void splice(std::span<const EditedSubtree> subtrees, std::size_t id_count);
  void list_nodes_of_vertices();
  RefittedOctree refitted(const VertexBuffer& vertices, std::span<const std::uint8_t> inert,
                          bool are_nodes_current = true) const {
    return {nodes_,   boxes_.data(), triangles_,       leaf_vertices(),
            vertices, inert,         unused_vertices_, are_nodes_current};
  }

  std::vector<OctreeNode> nodes_;
  std::vector<ChildBoxes> boxes_;
  std::unique_ptr<NodeVolumes> volumes_;
  std::vector<std::uint32_t> level_begin_;   // `OctreeTopology::level_begin`
  std::vector<std::uint64_t> cell_numbers_;  // `OctreeTopology::numbers`
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> triangle_ids_, triangle_order_;
  std::size_t vertex_count_;
  // `LeafVertexArrays`, and the vertices that no triangle uses, for methods of supple::comparison.
  std::vector<std::uint32_t> first_leaf_vertex_, leaf_vertices_, unused_vertices_;
  std::vector<std::uint8_t> leaf_corners_;
  /// The nodes with a leaf that contains vertex v are `nodes[first[v]]` up to `nodes[first[v + 1]]`, and the
  /// nodes to refit with a byte for each node.
  struct MovedVertices {
    std::vector<std::uint32_t> first, nodes, stale;
    std::vector<std::uint8_t> is_stale;
  };
  std::unique_ptr<MovedVertices> moved_;  // since the first `refit_moved`
  std::vector<std::uint8_t> is_current_;  // by node, since `LazyRefit::refit_object`
  ObjectOctreeOptions options_;
  BoundingVolume bounding_volume_;
  SphereFit sphere_fit_;
  Aabb box_;
};

}  // namespace supple
