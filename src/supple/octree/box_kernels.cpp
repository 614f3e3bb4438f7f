#include "octree/box_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/box_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "octree/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

Aabb BoxOfLanes(const AabbLanes& lanes) {
  return enclose_lanes(lanes);
}

template <class Box, class Scalar>
void refit_nodes(const OctreeNode* nodes, AabbLanes* boxes, const Scalar* vertices,
                 const TriangleArrays& arrays, std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t n = begin; n < end; ++n) {
    const OctreeNode& node = nodes[n];
    AabbLanes& lanes = boxes[n];
    for (int lane = 0; lane < node.lane_count; ++lane) {
      if (node.is_inner(lane)) continue;
      set_lane_to_triangles<Box>(lanes, lane, vertices, arrays, node.first_triangle[lane],
                                 node.first_triangle[lane + 1]);
    }
    invert_lanes_from(lanes, node.lane_count);
    if (node.parent == n) continue;
    const Aabb box = enclose_lanes(lanes);
    set_lane(boxes[node.parent], node.parent_lane, &box.min.x, &box.max.x);
  }
}

void RefitBoxes(const OctreeNode* nodes, AabbLanes* boxes, const TriangleArrays& arrays, std::uint32_t begin,
                std::uint32_t end) {
  if (arrays.doubles != nullptr) {
    refit_nodes<DoubleBox>(nodes, boxes, arrays.doubles, arrays, begin, end);
  } else {
    refit_nodes<FloatBox>(nodes, boxes, arrays.floats, arrays, begin, end);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(BoxOfLanes);
HWY_EXPORT(RefitBoxes);

Aabb box_of_lanes(const AabbLanes& lanes) {
  return HWY_DYNAMIC_DISPATCH(BoxOfLanes)(lanes);
}

void refit_boxes(const OctreeNode* nodes, AabbLanes* boxes, const TriangleArrays& arrays, std::uint32_t begin,
                 std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(RefitBoxes)(nodes, boxes, arrays, begin, end);
}

}  // namespace supple
#endif
