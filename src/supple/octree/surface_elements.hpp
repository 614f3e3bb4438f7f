#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/mesh.hpp"

namespace supple {

class ObjectOctree;

/// Two different vertices of a triangle; the smaller number is first.
using Edge = std::array<std::uint32_t, 2>;

/// A range of elements of one kind in the numbering of `SurfaceElements`.
struct ElementRange {
  std::uint32_t begin = 0, end = 0;

  std::uint32_t size() const { return end - begin; }
};

/// Vertices, edges and faces of an object in octree order. The first triangle that uses an element owns it,
/// and so does the leaf of this triangle. So the elements of consecutive triangles are contiguous, and each
/// pair of elements belongs to exactly one pair of leaves.
///
/// Vertices and edges are numbered by first use. An edge is a pair of different vertices of a triangle;
/// several triangles can share it. Faces are the triangles in octree order. Vertices that no triangle uses
/// are last and have no owner.
///
/// Memory: 4 bytes per vertex, 8 per edge, 20 per triangle.
class SurfaceElements {
 public:
  SurfaceElements() = default;
  /// O(n log n).
  explicit SurfaceElements(const ObjectOctree& octree);

  std::span<const Edge> edges() const { return edges_; }
  std::span<const Triangle> faces() const { return faces_; }
  /// The user's id of each vertex, also of unused ones.
  std::span<const std::uint32_t> vertex_ids() const { return vertex_ids_; }
  /// The number of vertices that triangles use.
  std::uint32_t vertex_count() const { return first_vertex_.back(); }
  std::uint32_t edge_count() const { return static_cast<std::uint32_t>(edges_.size()); }

  /// The elements that the triangles [begin, end) in octree order own.
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

 private:
  void number_by_first_use(const ObjectOctree& octree);

  std::vector<Edge> edges_;
  std::vector<Triangle> faces_;
  std::vector<std::uint32_t> vertex_ids_;
  std::vector<std::uint32_t> first_vertex_{0}, first_edge_{0};
};

}  // namespace supple
