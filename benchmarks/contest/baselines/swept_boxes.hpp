#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contest/contestant.hpp"

namespace supple::benchmarks {

/// The box around both ends of the step, in single precision. The coordinates are floats, so nothing is
/// rounded.
Aabb swept_box(const ClothStep& step, std::span<const std::uint32_t> vertices);
/// The box around the start of the step, grown by `margin` and by more than all rounding errors.
Aabb grown_box(const ClothStep& step, std::span<const std::uint32_t> vertices, double margin);

inline bool boxes_overlap(const Aabb& a, const Aabb& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

/// The elements of a cloth and their boxes in the current frame.
struct ClothBoxes {
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> used_vertices;  ///< only vertices used by a triangle
  std::vector<Aabb> boxes;                   ///< of all elements: vertices as `used_vertices`, edges, faces
  std::span<Aabb> vertex_boxes, edge_boxes, face_boxes;  ///< parts of `boxes`

  void prepare(const ClothStep& step);
  void update(const ClothStep& step) {
    update(step, [&](std::span<const std::uint32_t> vertices) { return swept_box(step, vertices); });
  }
  void update_grown(const ClothStep& step, double margin) {
    update(step, [&](std::span<const std::uint32_t> vertices) { return grown_box(step, vertices, margin); });
  }

  bool edges_share(std::uint32_t a, std::uint32_t b) const {
    return edges[a][0] == edges[b][0] || edges[a][0] == edges[b][1] || edges[a][1] == edges[b][0] ||
           edges[a][1] == edges[b][1];
  }

 private:
  template <class BoxOf>
  void update(const ClothStep& step, const BoxOf& box_of) {
    for (std::size_t i = 0; i < vertex_boxes.size(); ++i)
      vertex_boxes[i] = box_of(std::span(&used_vertices[i], 1));
    for (std::size_t i = 0; i < edge_boxes.size(); ++i) edge_boxes[i] = box_of(edges[i]);
    for (std::size_t i = 0; i < face_boxes.size(); ++i) face_boxes[i] = box_of(step.triangles[i]);
  }
};

inline bool has_corner(const Triangle& t, std::uint32_t vertex) {
  return t[0] == vertex || t[1] == vertex || t[2] == vertex;
}

}  // namespace supple::benchmarks
