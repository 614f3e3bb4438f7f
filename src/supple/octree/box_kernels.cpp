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
  // Named one by one: an array of them would live in memory.
  Box p, q, r, s;
  std::size_t i = begin;
  for (; i + 4 <= end; i += 4) {
    p.extend(vertices + i * 4);
    q.extend(vertices + i * 4 + 4);
    r.extend(vertices + i * 4 + 8);
    s.extend(vertices + i * 4 + 12);
  }
  for (; i < end; ++i) p.extend(vertices + i * 4);
  for (i = 0; i + 4 <= other_count; i += 4) {
    p.extend(vertices + std::size_t{others[i]} * 4);
    q.extend(vertices + std::size_t{others[i + 1]} * 4);
    r.extend(vertices + std::size_t{others[i + 2]} * 4);
    s.extend(vertices + std::size_t{others[i + 3]} * 4);
  }
  for (; i < other_count; ++i) p.extend(vertices + std::size_t{others[i]} * 4);
  p.extend(q);
  r.extend(s);
  p.extend(r);
  HWY_ALIGN float lower[4], upper[4];
  p.store(lower, upper);
  return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
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
