#include "octree/volumes/moving_box_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/volumes/moving_box_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "octree/refit_bottom_up.hpp"
#include "octree/volumes/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

void RoundCorners(const double* vertices, float* corners, std::uint32_t begin, std::uint32_t end) {
  constexpr float greatest = std::numeric_limits<float>::max();
  for (std::size_t vertex = begin; vertex < end; ++vertex) {
    DoubleBox box;
    box.extend(vertices + 3 * vertex);
    HWY_ALIGN float lower[4], upper[4];
    box.store(lower, upper);
    float* const target = corners + 8 * vertex;
    for (int axis = 0; axis < 3; ++axis) {
      target[axis] = std::max(lower[axis], -greatest);
      target[axis + 4] = std::min(upper[axis], greatest);
    }
  }
}

/// The box of the vertices of the faces [begin, end). Three boxes side by side, because each extension waits
/// for the one before.
HWY_INLINE FloatBox box_of_faces(const VertexCorners& corners, const Triangle* faces,
                                 const std::uint8_t* inert, std::uint32_t begin, std::uint32_t end) {
  FloatBox boxes[3];
  for (std::uint32_t f = begin; f < end; ++f) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t vertex = faces[f][corner], at = vertex * corners.step;
      if (inert == nullptr || inert[vertex] == 0)
        boxes[corner].extend(corners.lower + at, corners.upper + at);
    }
  }
  boxes[0].extend(boxes[1]);
  boxes[0].extend(boxes[2]);
  return boxes[0];
}

void RefitMovingBoxes(const OctreeNode* nodes, ChildBoxes* boxes, const VertexCorners& corners,
                      const Triangle* faces, const std::uint8_t* inert, std::uint32_t begin,
                      std::uint32_t end) {
  refit_bottom_up(
      nodes, begin, end,
      [&](std::uint32_t n, int child) HWY_ATTR {
        const std::uint32_t* const first = nodes[n].first_triangle + child;
        set_child(boxes[n], child, box_of_faces(corners, faces, inert, first[0], first[1]));
      },
      [&](std::uint32_t n) HWY_ATTR { unite_children(nodes, boxes, n); });
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(RoundCorners);
HWY_EXPORT(RefitMovingBoxes);

void round_corners(const double* vertices, float* corners, std::uint32_t begin, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(RoundCorners)(vertices, corners, begin, end);
}

void refit_moving_boxes(const OctreeNode* nodes, ChildBoxes* boxes, const VertexCorners& corners,
                        const Triangle* faces, const std::uint8_t* inert, std::uint32_t begin,
                        std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(RefitMovingBoxes)(nodes, boxes, corners, faces, inert, begin, end);
}

}  // namespace supple
#endif
