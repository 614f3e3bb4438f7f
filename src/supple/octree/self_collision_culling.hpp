#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "octree/moving_box_kernels.hpp"
#include "octree/object_octree.hpp"
#include "octree/vertex_buffer.hpp"

namespace supple {

/// Which lanes of an octree cannot touch themselves during a step in which every vertex goes straight: no two
/// elements of the lane's triangles that share no vertex. Most of a smooth surface is such, so that a
/// traversal against itself need not descend there. After Volino and Magnenat Thalmann, "Efficient
/// self-collision detection on smoothly discretized surface animations using geometrical shape regularity"
/// (1994), with a test of the contour in place of theirs, for moving surfaces of any topology, and with
/// bounds of the rounding errors.
///
/// A child is culled when for one direction n, at all times,
///  1. all its triangles face n: n · ((b − a) × (c − a)) > 0, and
///  2. seen along n, its boundary goes round a centre once: each edge strictly counter-clockwise.
/// The boundary is that of the lane's triangles as a chain: an edge as often as triangles have it in one
/// direction more than in the other. Why that is enough, seen along n at any one time: the number of
/// triangles over a point on no edge is the winding number of the boundary about it, because by (1) all count
/// positive. By (2) the boundary is a single loop, star-shaped and simple, so the number is 0 or 1: no two
/// triangles overlap. Suppose that a vertex v lies in a closed triangle T without v. The triangles about v
/// cover all directions from it, or v is on the boundary; the same goes for the point of T under v, whether
/// inside of T, of an edge of it, or a vertex. If either side covers all directions, the other overlaps with
/// it; if neither does, v is a vertex of the loop that lies on another part of the loop, which is simple. Two
/// edges without a common vertex that cross have triangles that overlap there, and if they overlap, a vertex
/// of one lies in a triangle of the other. So non-adjacent elements are apart in the projection, hence in
/// space.
///
/// Both conditions are quadratic in time: where their three Bernstein coefficients are positive, so are they.
/// Each coefficient is compared with a bound of its rounding error. Nothing is claimed of separations, of
/// positions that are translated afterwards and thereby rounded, nor when a vertex is not finite.
///
/// Memory: 8 bytes a boundary edge, 12 a lane and 80 a node.
class SelfCollisionCulling {
 public:
  SelfCollisionCulling() = default;
  /// Finds the boundaries, which depend on the triangles alone; O(n log n). `triangles` are the octree's, in
  /// any numbering of the vertices.
  SelfCollisionCulling(const ObjectOctree& octree, std::span<const Triangle> triangles);

  /// For the step from `start` to `end`, the same object when at rest; O(n). Takes no memory. The triangles
  /// are those given before.
  void refit(const ObjectOctree& octree, std::span<const Triangle> triangles, const VertexBuffer& start,
             const VertexBuffer& end, const Parallel& parallel);

  /// A byte a node: bit i says that lane i cannot touch itself.
  std::span<const std::uint8_t> masks() const { return masks_; }
  std::size_t bytes() const;

 private:
  /// Normals of triangles at all times, each scaled to greatest coordinate 1: their sum and bounds. A lane
  /// without hope has the bounds -1 and 1.
  struct Normals {
    Vec3d sum, low{1, 1, 1}, high{-1, -1, -1};
  };
  /// A range of `boundary_edges_`, empty where there is none or too much of it.
  struct Boundary {
    std::uint32_t begin = 0, end = 0;
  };

  template <class Scalar>
  void refit_node(std::span<const OctreeNode> nodes, std::span<const Triangle> triangles,
                  const VertexArray<Scalar>& start, const VertexArray<Scalar>& end, std::uint32_t n);
  template <class Scalar>
  static Normals normals_of(std::span<const Triangle> triangles, const VertexArray<Scalar>& start,
                            const VertexArray<Scalar>& end);
  template <class Scalar>
  bool goes_round_once(const Boundary& boundary, const Vec3d& n, const VertexArray<Scalar>& start,
                       const VertexArray<Scalar>& end) const;

  std::vector<Edge> boundary_edges_;  // directed
  std::vector<Boundary> boundaries_;  // eight a node
  std::vector<Normals> node_normals_;
  std::vector<std::uint8_t> masks_;
};

}  // namespace supple
