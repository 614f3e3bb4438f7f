#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "octree/object_octree.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Two different vertices of a triangle, the smaller number first.
using Edge = std::array<std::uint32_t, 2>;

/// A range of elements of one kind, the numbers of `SurfaceElements`.
struct ElementRange {
  std::uint32_t begin = 0, end = 0;

  std::uint32_t size() const { return end - begin; }
};

/// Vertices, edges and faces of an object in octree order, each owned by one leaf: the leaf of the first
/// triangle that uses it. So the elements of a leaf, or of any run of triangles, are contiguous, and a pair
/// of elements belongs to exactly one pair of leaves.
///
/// Vertices and edges are numbered by first use. An edge is a pair of different vertices of a triangle,
/// however many triangles share it. Faces are the triangles themselves, in the octree's order. Vertices that
/// no triangle uses come last and belong to none.
///
/// Memory: 4 bytes a vertex, 8 an edge, 20 a triangle.
class SurfaceElements {
 public:
  SurfaceElements() = default;
  /// O(n log n).
  explicit SurfaceElements(const ObjectOctree& octree);

  std::span<const Edge> edges() const { return edges_; }
  std::span<const Triangle> faces() const { return faces_; }
  /// Of all vertices, number to the user's.
  std::span<const std::uint32_t> vertex_ids() const { return vertex_ids_; }
  /// Number of vertices that a triangle uses.
  std::uint32_t vertex_count() const { return first_vertex_.back(); }
  std::uint32_t edge_count() const { return static_cast<std::uint32_t>(edges_.size()); }

  /// Owned by the triangles [begin, end) of the octree's order.
  ElementRange vertices_of(std::uint32_t begin, std::uint32_t end) const {
    return {first_vertex_[begin], first_vertex_[end]};
  }
  ElementRange edges_of(std::uint32_t begin, std::uint32_t end) const {
    return {first_edge_[begin], first_edge_[end]};
  }
  /// The same as arrays: triangle t owns [first[t], first[t + 1]).
  const std::uint32_t* first_vertex() const { return first_vertex_.data(); }
  const std::uint32_t* first_edge() const { return first_edge_.data(); }

  std::size_t bytes() const {
    return edges_.capacity() * sizeof(Edge) + faces_.capacity() * sizeof(Triangle) +
           (vertex_ids_.capacity() + first_vertex_.capacity() + first_edge_.capacity()) *
               sizeof(std::uint32_t);
  }
  /// The empty string when every invariant holds; else what is wrong. O(n log n).
  std::string validate(const ObjectOctree& octree) const;

 private:
  void number_by_first_use(const ObjectOctree& octree);

  std::vector<Edge> edges_;
  std::vector<Triangle> faces_;
  std::vector<std::uint32_t> vertex_ids_;
  std::vector<std::uint32_t> first_vertex_{0}, first_edge_{0};
};

}  // namespace supple
