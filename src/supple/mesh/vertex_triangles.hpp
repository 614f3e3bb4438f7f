#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "supple/mesh.hpp"

namespace supple {

/// The triangles around each vertex, and the connected parts of a surface. Memory: 8 bytes per vertex, 12
/// per triangle.
class VertexTriangles {
 public:
  /// O(n). Triangles that `inert` marks are left out; it may be empty.
  VertexTriangles(std::span<const Triangle> triangles, std::span<const std::uint8_t> inert,
                  std::size_t vertex_count);

  /// Ascending; a triangle with equal corners is there once.
  std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    return std::span(triangles_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }

  /// Vertices that triangles connect. Vertices without triangles are in no part.
  struct Part {
    std::uint32_t smallest_vertex = 0, vertex_count = 0;
  };
  static constexpr std::uint32_t no_part = ~std::uint32_t{0};
  std::span<const Part> parts() const { return parts_; }
  std::uint32_t part_of(std::uint32_t vertex) const { return part_[vertex]; }
  std::size_t vertex_count() const { return part_.size(); }

 private:
  std::vector<std::uint32_t> first_, triangles_, part_;
  std::vector<Part> parts_;
};

}  // namespace supple
