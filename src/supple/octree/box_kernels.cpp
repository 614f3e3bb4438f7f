#include "octree/box_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/box_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "octree/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

Aabb BoxOfLanes(const AabbLanes& lanes) {
  return enclose_lanes(lanes);
}

/// A node without inner lanes, as most are; gives its box.
template <class Box, class Scalar>
HWY_INLINE Box refit_bottom_node(const OctreeNode& node, AabbLanes& lanes, const Scalar* vertices,
                                 const TriangleArrays& arrays) {
  Box all;
  for (int first = 0; first < node_width; first += 4) {
    Box boxes[4];
    const int count = std::min(node.lane_count - first, 4);
    for (int i = 0; i < count; ++i) {
      boxes[i] = box_of_triangles<Box>(vertices, arrays, node.first_triangle[first + i],
                                       node.first_triangle[first + i + 1]);
      all.extend(boxes[i]);
    }
    set_four_lanes(lanes, first, boxes);
  }
  return all;
}

template <class Box, class Scalar>
void refit_nodes(const OctreeNode* nodes, AabbLanes* boxes, const Scalar* vertices,
                 const TriangleArrays& arrays, std::uint32_t begin, std::uint32_t end, std::uint32_t root) {
  for (std::uint32_t n = begin; n < end; ++n) {
    const OctreeNode& node = nodes[n];
    AabbLanes& lanes = boxes[n];
    if (node.inner_mask == 0) {
      const Box box = refit_bottom_node<Box>(node, lanes, vertices, arrays);
      invert_lanes_from(lanes, node.lane_count);
      if (n != root) set_lane(boxes[node.parent], node.parent_lane, box);
      continue;
    }
    for (int lane = 0; lane < node.lane_count; ++lane) {
      if (node.is_inner(lane)) continue;
      set_lane(
          lanes, lane,
          box_of_triangles<Box>(vertices, arrays, node.first_triangle[lane], node.first_triangle[lane + 1]));
    }
    invert_lanes_from(lanes, node.lane_count);
    if (n == root) continue;
    const Aabb box = enclose_lanes(lanes);
    set_lane(boxes[node.parent], node.parent_lane, &box.min.x, &box.max.x);
  }
}

void RefitBoxes(const OctreeNode* nodes, AabbLanes* boxes, const TriangleArrays& arrays, std::uint32_t begin,
                std::uint32_t end, std::uint32_t root) {
  if (arrays.doubles != nullptr) {
    refit_nodes<DoubleBox>(nodes, boxes, arrays.doubles, arrays, begin, end, root);
  } else {
    refit_nodes<FloatBox>(nodes, boxes, arrays.floats, arrays, begin, end, root);
  }
}

/// Several boxes side by side, for each waits for its own last vertex.
template <class Box, class Scalar>
Aabb enclose_vertices(const Scalar* vertices, std::uint32_t begin, std::uint32_t end,
                      const std::uint32_t* others, std::size_t other_count) {
  constexpr std::size_t width = 4;
  Box boxes[width];
  std::size_t i = begin;
  for (; i + width <= end; i += width) {
    for (std::size_t k = 0; k < width; ++k) boxes[k].extend(vertices + (i + k) * 4);
  }
  for (; i < end; ++i) boxes[0].extend(vertices + i * 4);
  for (i = 0; i + width <= other_count; i += width) {
    for (std::size_t k = 0; k < width; ++k) boxes[k].extend(vertices + std::size_t{others[i + k]} * 4);
  }
  for (; i < other_count; ++i) boxes[0].extend(vertices + std::size_t{others[i]} * 4);
  Aabb result;
  for (const Box& box : boxes) {
    HWY_ALIGN float lower[4], upper[4];
    box.store(lower, upper);
    for (int axis = 0; axis < 3; ++axis) {
      result.min[axis] = std::min(result.min[axis], lower[axis]);
      result.max[axis] = std::max(result.max[axis], upper[axis]);
    }
  }
  return result;
}

Aabb BoxOfVertices(const TriangleArrays& arrays, std::uint32_t begin, std::uint32_t end,
                   const std::uint32_t* others, std::size_t other_count) {
  return arrays.doubles != nullptr
             ? enclose_vertices<DoubleBox>(arrays.doubles, begin, end, others, other_count)
             : enclose_vertices<FloatBox>(arrays.floats, begin, end, others, other_count);
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(BoxOfLanes);
HWY_EXPORT(RefitBoxes);
HWY_EXPORT(BoxOfVertices);

Aabb box_of_lanes(const AabbLanes& lanes) {
  return HWY_DYNAMIC_DISPATCH(BoxOfLanes)(lanes);
}

void refit_boxes(const OctreeNode* nodes, AabbLanes* boxes, const TriangleArrays& arrays, std::uint32_t begin,
                 std::uint32_t end, std::uint32_t root) {
  HWY_DYNAMIC_DISPATCH(RefitBoxes)(nodes, boxes, arrays, begin, end, root);
}

Aabb box_of_vertices(const TriangleArrays& arrays, std::uint32_t begin, std::uint32_t end,
                     std::span<const std::uint32_t> others) {
  return HWY_DYNAMIC_DISPATCH(BoxOfVertices)(arrays, begin, end, others.data(), others.size());
}

}  // namespace supple
#endif
