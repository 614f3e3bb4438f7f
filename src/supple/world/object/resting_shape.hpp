#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/sort_once.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/comparison_methods.hpp"
#include "octree/object_octree.hpp"
#include "world/object/adaptive_culling.hpp"
#include "world/object/placement.hpp"

namespace supple {

/// The data of an object for the search for intersections: the octree's volumes at the current positions,
/// which this class updates.
class RestingShape {
 public:
  /// Triangles with ids from `face_count` on are always inert.
  explicit RestingShape(std::uint32_t face_count) : face_count_(face_count) {}

  bool is_current(const Placement& placement) const { return version_ == placement.version(); }
  /// Refits the octree, or only the part that moved since the last update, and bakes the translation if
  /// necessary. O(n). Returns the number of triangles in refitted leaves.
  std::size_t update(ObjectOctree& octree, Placement& placement, const Parallel& parallel);
  /// As `update`, but only the volume of the whole object, where that is possible; then `update_children`
  /// computes the volumes of nodes. `box`, if any, encloses the positions, which are finite.
  std::size_t update_object(ObjectOctree& octree, Placement& placement, const std::optional<Aabb>& box,
                            const Parallel& parallel);
  bool has_object(const Placement& placement) const {
    return is_current(placement) || object_version_ == placement.version();
  }
  /// The children of a node, after `update_object`. Returns the number of triangles that it read.
  std::size_t update_children(ObjectOctree& octree, const Placement& placement, std::uint32_t node) const {
    return is_current(placement) ? 0 : comparison_methods({}).refit_children(octree, node, placement.end());
  }
  void update_culling(const ObjectOctree& octree, const Placement& placement, const Parallel& parallel) {
    culling_.update(version_, octree, octree.triangles(), placement.end(), placement.end(), parallel);
  }

  OctreeView view(const ObjectOctree& octree, const Placement& placement) const;
  /// The user's ids at the last update, ascending.
  std::span<const std::uint32_t> non_finite_vertices() const { return non_finite_; }
  bool has_inert_faces() const { return has_inert_faces_; }
  std::size_t bytes() const { return inert_.capacity() + culling_.bytes(); }

  /// Call after the octree was rebuilt or edited.
  void forget_octree(std::uint32_t face_count) {
    face_count_ = face_count;
    version_ = object_version_ = 0;
    culling_.forget_octree();
  }

 private:
  std::size_t refit(ObjectOctree& octree, Placement& placement, const Parallel& parallel);
  void refit_all(ObjectOctree& octree, const Placement& placement, const Parallel& parallel);

  std::uint32_t face_count_;
  std::uint64_t version_ = 0;
  std::uint64_t object_version_ = 0;  // of the volume of the whole object, if that of the nodes is older
  std::vector<std::uint8_t> inert_;   // `mark_inert`, or empty when there are no inert triangles
  bool has_inert_faces_ = false;
  std::vector<std::uint32_t> non_finite_;
  AdaptiveCulling culling_;
};

/// Lists the user's ids, ascending, of the vertices of triangles, edges and points for which
/// `is_finite_at(v)` is false. Nothing reads other vertices, for example those that were welded to another
/// one. O(n log n).
template <class IsFinite>
void list_non_finite(const ObjectOctree& octree, const IsFinite& is_finite_at,
                     std::vector<std::uint32_t>& vertices) {
  vertices.clear();
  for (const Triangle& triangle : octree.triangles()) {
    for (const std::uint32_t v : triangle) {
      if (!is_finite_at(v)) vertices.push_back(v);
    }
  }
  sort_once(vertices);
}

/// Sets a byte per triangle in octree order: 1 when a vertex of the triangle is not finite, and for triangles
/// with ids from `face_count` on. Returns whether there are some of the first kind.
bool mark_inert(const ObjectOctree& octree, const VertexBuffer& vertices, std::uint32_t face_count,
                std::vector<std::uint8_t>& inert);

}  // namespace supple
