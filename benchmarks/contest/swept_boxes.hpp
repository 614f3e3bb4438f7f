#pragma once

#include <vector>

#include "contest/contestant.hpp"

namespace supple::benchmarks {

/// The box around both ends of the step, in single precision. The coordinates are floats, so nothing is
/// rounded.
Aabb swept_box(const ClothStep& step, std::span<const std::uint32_t> vertices);

inline bool boxes_overlap(const Aabb& a, const Aabb& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

/// The elements of a cloth and their boxes in the current frame.
struct ClothBoxes {
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> used_vertices;                ///< only vertices used by a triangle
  std::vector<Aabb> vertex_boxes, edge_boxes, face_boxes;  ///< vertex_boxes: indexed as `used_vertices`

  void prepare(const ClothStep& step);
  void update(const ClothStep& step);

  bool edges_share(std::uint32_t a, std::uint32_t b) const {
    return edges[a][0] == edges[b][0] || edges[a][0] == edges[b][1] || edges[a][1] == edges[b][0] ||
           edges[a][1] == edges[b][1];
  }
};

inline bool has_corner(const Triangle& t, std::uint32_t vertex) {
  return t[0] == vertex || t[1] == vertex || t[2] == vertex;
}

}  // namespace supple::benchmarks
