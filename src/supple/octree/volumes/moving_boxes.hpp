#pragma once

#include <cstdint>
#include <vector>

#include "core/parallel.hpp"
#include "octree/octree_node.hpp"
#include "octree/surface_elements.hpp"
#include "octree/vertex_buffer.hpp"
#include "octree/volumes/moving_box_kernels.hpp"

namespace supple {

class ObjectOctree;

/// What the narrow phase reads of an object in motion; borrowed. `start` is null when the object has no
/// moving boxes.
struct MovingView {
  const ChildBoxes* start = nullptr;  ///< by node
  const ChildBoxes* end = nullptr;
  VertexCorners start_corners, end_corners;
  const std::uint8_t* inert = nullptr;  ///< a byte per vertex, or null when all are finite
  const Triangle* face_ids = nullptr;
  const Edge* edge_ids = nullptr;
  const std::uint32_t* first_vertex = nullptr;
  const std::uint32_t* first_edge = nullptr;
};

/// Boxes of the nodes of an octree at the start and at the end of a step in which every vertex moves on a
/// straight line. At each time, the box between both encloses what the node contains. So two nodes that are
/// separated on the same side of one axis at both ends are separated all the time. This excludes far more
/// pairs than one box around the whole motion. The narrow phase computes the boxes of vertices, edges and
/// faces, for the leaves that it meets.
///
/// Boxes are rounded outward and stay within the range of float, so that an inverted box overlaps no other
/// box. A vertex with a coordinate that is not finite at either end is inert, and so are its edges and faces.
/// The box of a child encloses all vertices of its triangles that are not inert.
///
/// Memory: twice 192 bytes a node; half when at rest, and for positions in double precision 64 more a vertex.
class MovingBoxes {
 public:
  /// Computes all boxes in O(n). Pass the same buffer twice for an object at rest. Floats stay borrowed until
  /// the next call. Takes no memory after the first call. Returns whether all vertices are finite at both
  /// ends.
  bool refit(const ObjectOctree& octree, const SurfaceElements& elements, const VertexBuffer& start,
             const VertexBuffer& end, const Parallel& parallel);

  /// The boxes of the last refit.
  MovingView view(const SurfaceElements& elements) const;
  bool at_rest() const { return at_rest_; }
  /// Boxes of the whole object; empty when it has no finite element.
  Aabb start_box() const;
  Aabb end_box() const;
  /// Encloses the whole motion.
  Aabb swept_box() const;

  std::size_t bytes() const;

 private:
  /// Boxes at one end of the step.
  struct Moment {
    std::vector<float> rounded;  // `round_corners` of double positions
    VertexCorners corners;
    std::vector<ChildBoxes> nodes;
  };

  void refit(Moment& moment, const ObjectOctree& octree, const SurfaceElements& elements,
             const VertexBuffer& positions, const std::uint8_t* inert, const Parallel& parallel) const;
  bool mark_inert(const VertexBuffer& start, const VertexBuffer& end, const Parallel& parallel);
  const Moment& last() const { return at_rest_ ? start_ : end_; }

  Moment start_, end_;
  bool at_rest_ = true;
  std::vector<std::uint8_t> inert_;  // a byte per vertex, or empty when all are finite
};

}  // namespace supple
