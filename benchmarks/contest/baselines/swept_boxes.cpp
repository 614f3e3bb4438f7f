#include "contest/baselines/swept_boxes.hpp"

#include <algorithm>
#include <cmath>

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

Aabb grown_box(const ClothStep& step, std::span<const std::uint32_t> vertices, double margin) {
  Aabb box;
  for (const std::uint32_t vertex : vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<float>(step.start[vertex][axis]);
      box.min[axis] = std::min(box.min[axis], x);
      box.max[axis] = std::max(box.max[axis], x);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const float size = std::max(std::fabs(box.min[axis]), std::fabs(box.max[axis]));
    const float by = static_cast<float>(margin) * (1 + 0x1p-20f) + size * 0x1p-22f;
    box.min[axis] -= by;
    box.max[axis] += by;
  }
  return box;
}

void ClothBoxes::prepare(const ClothStep& step) {
  edges = edges_of(step.triangles);
  for (const Triangle& t : step.triangles) used_vertices.insert(used_vertices.end(), t.begin(), t.end());
  std::sort(used_vertices.begin(), used_vertices.end());
  used_vertices.erase(std::unique(used_vertices.begin(), used_vertices.end()), used_vertices.end());
  boxes.resize(used_vertices.size() + edges.size() + step.triangles.size());
  vertex_boxes = std::span(boxes).first(used_vertices.size());
  edge_boxes = std::span(boxes).subspan(used_vertices.size(), edges.size());
  face_boxes = std::span(boxes).last(step.triangles.size());
}

}  // namespace supple::benchmarks
