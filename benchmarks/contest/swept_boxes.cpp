#include "contest/swept_boxes.hpp"

#include <algorithm>

namespace supple::benchmarks {

Aabb swept_box(const ClothStep& step, std::span<const std::uint32_t> vertices) {
  Aabb box;
  for (const std::uint32_t vertex : vertices) {
    for (const Vec3d* const p : {&step.start[vertex], &step.end[vertex]}) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto x = static_cast<float>((*p)[axis]);
        box.min[axis] = std::min(box.min[axis], x);
        box.max[axis] = std::max(box.max[axis], x);
      }
    }
  }
  return box;
}

void ClothBoxes::prepare(const ClothStep& step) {
  edges = edges_of(step.triangles);
  for (const Triangle& t : step.triangles) used_vertices.insert(used_vertices.end(), t.begin(), t.end());
  std::sort(used_vertices.begin(), used_vertices.end());
  used_vertices.erase(std::unique(used_vertices.begin(), used_vertices.end()), used_vertices.end());
  vertex_boxes.resize(used_vertices.size());
  edge_boxes.resize(edges.size());
  face_boxes.resize(step.triangles.size());
}

void ClothBoxes::update(const ClothStep& step) {
  for (std::size_t i = 0; i < vertex_boxes.size(); ++i)
    vertex_boxes[i] = swept_box(step, std::span(&used_vertices[i], 1));
  for (std::size_t i = 0; i < edge_boxes.size(); ++i) edge_boxes[i] = swept_box(step, edges[i]);
  for (std::size_t i = 0; i < face_boxes.size(); ++i) face_boxes[i] = swept_box(step, step.triangles[i]);
}

}  // namespace supple::benchmarks
