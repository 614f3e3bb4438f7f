#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/object_octree.hpp"
#include "octree/surface_elements.hpp"
#include "octree/volumes/moving_boxes.hpp"
#include "world/object/adaptive_culling.hpp"
#include "world/object/placement.hpp"

namespace supple {

/// The data of an object for the search for continuous contacts or proximity: its elements, their positions
/// at both ends of the step, and boxes around them. Takes memory only after the first request.
class MovingShape {
 public:
  /// The elements' whole way, or only its end.
  enum class Part : std::uint8_t { way, end };
  explicit MovingShape(Part part) : part_(part) {}

  bool is_current(const Placement& placement) const { return version_ == placement.version(); }
  /// Computes the boxes, and bakes the translation if necessary. O(n), the first time O(n log n).
  void update(const ObjectOctree& octree, Placement& placement, const Parallel& parallel);
  void update_culling(const ObjectOctree& octree, const Parallel& parallel) {
    culling_.update(version_, octree, elements_.faces(), start(), end_, parallel);
  }

  OctreeView view(const ObjectOctree& octree, const Placement& placement) const;
  const SurfaceElements& elements() const { return elements_; }
  const MovingBoxes& boxes() const { return boxes_; }
  /// Positions in the elements' numbering, without the placement's translation. At rest, `start` and `end`
  /// are the same buffer.
  const VertexBuffer& start() const { return boxes_.at_rest() ? end_ : start_; }
  const VertexBuffer& end() const { return end_; }
  /// The box around the whole motion, without the placement's translation.
  Aabb box() const { return boxes_.swept_box(); }
  /// Boxes of the octree's nodes at the end of the step.
  const ChildBoxes* node_boxes() const { return boxes_.view(elements_).end; }
  /// The user's ids of vertices that were not finite at one end of the step at the last update, ascending.
  std::span<const std::uint32_t> non_finite_vertices() const { return non_finite_; }
  std::size_t bytes() const;

  /// Call after the octree was rebuilt or edited.
  void forget_octree() {
    version_ = 0;
    elements_ = {};
    culling_.forget_octree();
  }

 private:
  void refit(const ObjectOctree& octree, const Placement& placement, const Parallel& parallel);

  bool has_way(const Placement& placement) const { return part_ == Part::way && placement.has_motion(); }

  Part part_;
  std::uint64_t version_ = 0;
  SurfaceElements elements_;
  VertexBuffer start_, end_;
  MovingBoxes boxes_;
  std::vector<std::uint32_t> non_finite_;
  AdaptiveCulling culling_;
};

}  // namespace supple
