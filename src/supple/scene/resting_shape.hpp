#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/object_octree.hpp"
#include "scene/placement.hpp"
#include "scene/unfolded_lanes.hpp"

namespace supple {

/// What the search for intersections reads of an object: the octree's volumes at the positions where the
/// object is now, which this brings up to date.
class RestingShape {
 public:
  bool is_current(const Placement& placement) const { return version_ == placement.version(); }
  /// Refits the octree, and bakes the translation where it must be. O(n).
  void update(ObjectOctree& octree, Placement& placement, const Parallel& parallel);
  void update_unfolded(const ObjectOctree& octree, const Placement& placement, const Parallel& parallel) {
    unfolded_.update(version_, octree, octree.triangles(), placement.end(), placement.end(), parallel);
  }

  OctreeView view(const ObjectOctree& octree, const Placement& placement) const;
  /// User's numbers, ascending; as of the last update.
  std::span<const std::uint32_t> non_finite_vertices() const { return non_finite_; }
  const UnfoldedLanes& unfolded() const { return unfolded_; }
  std::string validate(const ObjectOctree& octree, const Placement& placement) const {
    return octree.validate(placement.end(), inert_);
  }
  std::size_t bytes() const { return inert_.capacity() + unfolded_.bytes(); }

  /// Call after the octree was rebuilt.
  void forget_octree() {
    version_ = 0;
    unfolded_.forget_octree();
  }

 private:
  void refit(ObjectOctree& octree, const Placement& placement, const Parallel& parallel);

  std::uint64_t version_ = 0;
  std::vector<std::uint8_t> inert_;  // a byte a triangle in octree order, or empty
  std::vector<std::uint32_t> non_finite_;
  UnfoldedLanes unfolded_;
};

/// A byte a triangle: whether a vertex of it is not finite.
void mark_inert(const ObjectOctree& octree, const VertexBuffer& vertices, std::vector<std::uint8_t>& inert);

}  // namespace supple
