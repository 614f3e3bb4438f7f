#include "octree/box_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/box_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "octree/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

HWY_INLINE float min_of_eight(const float* values) {
  const hn::CappedTag<float, node_width> tag;
  auto least = hn::Load(tag, values);
  for (std::size_t i = hn::Lanes(tag); i < node_width; i += hn::Lanes(tag)) {
    least = hn::Min(least, hn::Load(tag, values + i));
  }
  return hn::GetLane(hn::MinOfLanes(tag, least));
}

HWY_INLINE float max_of_eight(const float* values) {
  const hn::CappedTag<float, node_width> tag;
  auto greatest = hn::Load(tag, values);
  for (std::size_t i = hn::Lanes(tag); i < node_width; i += hn::Lanes(tag)) {
    greatest = hn::Max(greatest, hn::Load(tag, values + i));
  }
  return hn::GetLane(hn::MaxOfLanes(tag, greatest));
}

Aabb BoxOfLanes(const AabbLanes& lanes) {
  return {{min_of_eight(lanes.min_x), min_of_eight(lanes.min_y), min_of_eight(lanes.min_z)},
          {max_of_eight(lanes.max_x), max_of_eight(lanes.max_y), max_of_eight(lanes.max_z)}};
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
    const Aabb box = BoxOfLanes(lanes);
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
