#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "octree/moving_box_kernels.hpp"
#include "octree/object_octree.hpp"
#include "octree/surface_elements.hpp"
#include "octree/vertex_buffer.hpp"

namespace supple {

/// Boxes of elements at the start and at the end of a step. At rest both are the same arrays.
struct MovingBoxArrays {
  const float* start = nullptr;
  const float* end = nullptr;
  std::size_t stride = 0;  ///< between the six arrays of each: min x, y, z, max x, y, z
};

/// What the narrow phase reads of an object in motion; borrowed. `start` is null when the object has no
/// moving boxes.
struct MovingView {
  const ChildBoxes* start = nullptr;  ///< by node
  const ChildBoxes* end = nullptr;
  MovingBoxArrays vertices, edges, faces;
  const Triangle* face_ids = nullptr;
  const Edge* edge_ids = nullptr;
  const std::uint32_t* first_vertex = nullptr;
  const std::uint32_t* first_edge = nullptr;
};

/// Boxes of the vertices, edges and faces of an object and of its octree's nodes, at the start and at the end
/// of a step in which every vertex moves on a straight line. At each time, the box between both encloses the
/// element. So two elements that are separated on the same side of one axis at both ends are separated all
/// the time. This excludes far more pairs than one box around the whole motion.
///
/// Boxes are rounded outward and stay within the range of float, so that an inverted box overlaps no other
/// box. An element with a coordinate that is not finite at either end is inert: its box is inverted. The
/// other elements of its triangles are not inert. The box of a child encloses all elements that its triangles
/// own.
///
/// Memory: 48 bytes a vertex, edge and face, twice 192 a node; half when at rest, and for positions in double
/// precision 64 more a vertex.
class MovingBoxes {
 public:
  /// Computes all boxes in O(n). Pass the same buffer twice for an object at rest. Takes no memory after the
  /// first call. Returns whether all vertices are finite at both ends.
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
  /// The empty string when every box is that of its elements; otherwise what is wrong.
  std::string validate(const ObjectOctree& octree, const SurfaceElements& elements, const VertexBuffer& start,
                       const VertexBuffer& end) const;

 private:
  /// Boxes at one end of the step.
  struct Moment {
    std::vector<float> corners;  // `round_corners` of double positions
    std::vector<float> vertices, edges, faces;
    std::vector<ChildBoxes> nodes;

    std::size_t bytes() const;
  };

  void set_boxes(Moment& moment, const VertexBuffer& positions, const SurfaceElements& elements,
                 std::span<const Triangle> faces, const Parallel& parallel);
  bool mark_inert(const VertexBuffer& start, const VertexBuffer& end, const Parallel& parallel);
  void invert_inert(Moment& moment, const SurfaceElements& elements, std::span<const Triangle> faces) const;
  void refit_nodes(Moment& moment, const ObjectOctree& octree, const SurfaceElements& elements,
                   bool faces_enclose, const Parallel& parallel) const;
  const Moment& last() const { return at_rest_ ? start_ : end_; }

  Moment start_, end_;
  bool at_rest_ = true;
  std::vector<std::uint8_t> inert_;  // a byte per vertex; valid when some are inert
};

}  // namespace supple
