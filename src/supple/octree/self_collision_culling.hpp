#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "octree/octree_node.hpp"
#include "octree/vertex_buffer.hpp"
#include "octree/volumes/moving_box_kernels.hpp"

namespace supple {

class ObjectOctree;

/// Finds the children of octree nodes that cannot touch themselves during a step in which every vertex moves
/// on a straight line: no two elements of the child's triangles touch unless they share a vertex. A traversal
/// of an object against itself skips these children, which are most of a smooth surface. After Volino and
/// Magnenat Thalmann, "Efficient self-collision detection on smoothly discretized surface animations using
/// geometrical shape regularity" (1994), with another test of the boundary, for moving surfaces of any
/// topology, and with bounds of the rounding errors.
///
/// A child is culled when for one direction n, at all times,
///  1. all its triangles face n: n · ((b − a) × (c − a)) > 0, and
///  2. seen along n, its boundary goes around a centre once: each edge runs strictly counter-clockwise.
/// The boundary is that of the triangles as a chain: an edge counts as often as it occurs in one direction
/// more than in the other.
///
/// Proof, for one time and seen along n: all triangles count positive by (1). So the number of triangles over
/// a point that is on no edge equals the winding number of the boundary around that point. By (2) the
/// boundary is a single loop, star-shaped and simple, so this number is 0 or 1: no two triangles overlap.
/// Suppose that a vertex v lies in a closed triangle T that does not have v as a corner. Either the triangles
/// around v cover all directions from v, or v is on the boundary. The same holds for the point of T under v,
/// whether it is inside T, on an edge or a corner. If either side covers all directions, the other one
/// overlaps with it, which is impossible. If neither does, v is a vertex of the loop and lies on another part
/// of the loop, which is impossible because the loop is simple. Suppose that two edges without a common
/// vertex touch. Where they cross, their triangles overlap; where they do not cross, a vertex of one lies in
/// a triangle of the other. Both are impossible. So elements that share no vertex are separated in the
/// projection, and hence in space.
///
/// Both conditions are quadratic in time: they hold if their three Bernstein coefficients are positive. Each
/// coefficient is compared with a bound of its rounding error. The result holds for separation 0, for the
/// positions as they are (a translation rounds them), and when all vertices are finite.
///
/// Memory: 8 bytes per boundary edge and 137 per node.
class SelfCollisionCulling {
 public:
  SelfCollisionCulling() = default;
  /// Finds the boundaries, which depend only on the triangles; O(n log n). `triangles` are those of the
  /// octree, with any numbering of the vertices.
  SelfCollisionCulling(const ObjectOctree& octree, std::span<const Triangle> triangles);

  /// Tests all children for the step from `start` to `end` in O(n), without taking memory. Pass the same
  /// buffer twice for an object at rest, and the same triangles as to the constructor.
  void refit(const ObjectOctree& octree, std::span<const Triangle> triangles, const VertexBuffer& start,
             const VertexBuffer& end, const Parallel& parallel);

  /// A byte per node: bit i is set when child i cannot touch itself.
  std::span<const std::uint8_t> masks() const { return masks_; }
  std::size_t bytes() const;

 private:
  /// The sum and the bounds of the normals of triangles at all times, each scaled to largest coordinate 1.
  /// When the normals differ too much, the bounds are -1 and 1.
  struct Normals {
    Vec3d sum, low{1, 1, 1}, high{-1, -1, -1};
  };
  /// A range of `boundary_edges_`; empty when the boundary is empty or too long.
  struct Boundary {
    std::uint32_t begin = 0, end = 0;
  };

  template <class Scalar>
  void refit_nodes(std::span<const OctreeNode> nodes, std::span<const Triangle> triangles,
                   const VertexArray<Scalar>& start, const VertexArray<Scalar>& end, std::uint32_t node_begin,
                   std::uint32_t node_end);
  template <class Scalar>
  static Normals normals_of(std::span<const Triangle> triangles, const VertexArray<Scalar>& start,
                            const VertexArray<Scalar>& end);
  template <class Scalar>
  bool goes_round_once(const Boundary& boundary, const Vec3d& n, const VertexArray<Scalar>& start,
                       const VertexArray<Scalar>& end) const;

  std::vector<Edge> boundary_edges_;  // directed
  std::vector<Boundary> boundaries_;  // eight per node
  std::vector<Normals> node_normals_;
  std::vector<std::uint8_t> masks_;
};

}  // namespace supple
