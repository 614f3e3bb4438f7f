#pragma once

#include <cstdint>
#include <span>

#include "octree/octree_node.hpp"
#include "octree/vertex_buffer.hpp"
#include "octree/volumes/box_kernels.hpp"
#include "supple/comparison_options.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Fits spheres to the children of an octree's nodes and to the whole object.
///
/// `SphereFit::minimal` starts with the sphere of `SphereFit::vertices`. Then it finds the vertex farthest
/// from the centre and computes the smallest sphere of this vertex and of the up to four vertices on the
/// sphere before, again and again, until no vertex is outside. (Gärtner, "Fast and robust smallest enclosing
/// balls", 1999.) It takes the smallest of these spheres after their radii reached the farthest vertex, so
/// the result encloses all vertices and is never larger than the first, even when rounding ends the search
/// early.
///
/// Both fits search the farthest vertex below a node top-down and skip children whose sphere ends before the
/// farthest vertex so far. So the spheres of deeper nodes must be fitted before.
///
/// All arrays are borrowed.
struct SphereFitter {
  SphereFit fit;
  std::span<const OctreeNode> nodes;
  const ChildSpheres* spheres;
  LeafVertexArrays leaves;
  std::span<const Triangle> triangles;
  const VertexBuffer& vertices;
  std::span<const std::uint8_t> inert;  ///< a byte per triangle, or empty
  /// False: the spheres of deeper nodes are out of date, so all vertices are searched.
  bool are_nodes_current = true;

  /// The sphere of a child, whose box is `box`.
  BoundingSphere sphere_of_child(std::uint32_t node, int child, const Aabb& box) const;
  /// The sphere of the whole object, whose box is `box`.
  BoundingSphere sphere_of_object(const Aabb& box) const;
};

}  // namespace supple
