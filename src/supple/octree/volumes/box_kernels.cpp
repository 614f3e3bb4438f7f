#include "octree/volumes/box_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/volumes/box_kernels.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "octree/volumes/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

/// Four boxes side by side, because each extension waits for the one before.
template <class Box, class Scalar>
HWY_INLINE Box box_of_vertices(VertexArray<Scalar> positions, const std::uint32_t* vertices,
                               std::size_t count, std::size_t ahead) {
  static_assert(leaf_vertices_step == 4);
  // Four variables, because an array would be in memory.
  Box p, q, r, s;
  for (std::size_t i = 0; i < count; i += 4) {
    // Every second vertex is enough: vertices that follow each other are usually neighbours in memory.
    hwy::Prefetch(positions[vertices[i + ahead]]);
    hwy::Prefetch(positions[vertices[i + ahead + 2]]);
    p.extend(positions[vertices[i]]);
    q.extend(positions[vertices[i + 1]]);
    r.extend(positions[vertices[i + 2]]);
    s.extend(positions[vertices[i + 3]]);
  }
  p.extend(q);
  r.extend(s);
  p.extend(r);
  return p;
}

template <class Box, class Scalar>
HWY_INLINE Box box_of_leaf(const OctreeNode& node, int child, VertexArray<Scalar> positions,
                           const TriangleArrays& arrays, const std::uint32_t* first,
                           const LeafVertexArrays& leaves) {
  if (arrays.inert == nullptr) {
    return box_of_vertices<Box>(positions, leaves.vertices + first[child], first[child + 1] - first[child],
                                leaves.ahead);
  }
  Box box;
  for (std::uint32_t t = node.first_triangle[child]; t < node.first_triangle[child + 1]; ++t) {
    if (arrays.inert[t] == 0) extend_by_triangle(box, positions, arrays.triangles[t]);
  }
  return box;
}

/// Refits a node whose children are all leaves, as in most nodes, and returns its box.
template <class Box, class Scalar>
HWY_INLINE Box refit_bottom_node(const OctreeNode& node, ChildBoxes& children, VertexArray<Scalar> positions,
                                 const TriangleArrays& arrays, const std::uint32_t* first,
                                 const LeafVertexArrays& leaves) {
  Box all;
  for (int begin = 0; begin < node_width; begin += 4) {
    Box boxes[4];
    const int count = std::min(node.child_count - begin, 4);
    for (int i = 0; i < count; ++i) {
      boxes[i] = box_of_leaf<Box>(node, begin + i, positions, arrays, first, leaves);
      all.extend(boxes[i]);
    }
    set_four_boxes(children, static_cast<std::size_t>(begin), boxes);
  }
  invert_children_from(children, node.child_count);
  return all;
}

/// Does not use `refit_bottom_up`: taking the leaves of bottom nodes four at a time is a tenth faster.
template <class Box, class Scalar>
bool refit_nodes(const OctreeNode* nodes, ChildBoxes* boxes, VertexArray<Scalar> positions,
                 const TriangleArrays& arrays, const LeafVertexArrays& leaves, std::uint32_t begin,
                 std::uint32_t end) {
  bool all_finite = true;
  for (std::uint32_t n = begin; n < end; ++n) {
    const OctreeNode& node = nodes[n];
    const std::uint32_t* const first = leaves.first + std::size_t{n} * node_width;
    ChildBoxes& children = boxes[n];
    if (node.inner_mask == 0) {
      const Box box = refit_bottom_node<Box>(node, children, positions, arrays, first, leaves);
      all_finite = box.all_finite() && all_finite;
      if (node.parent != n) set_child(boxes[node.parent], node.index_in_parent, box);
      continue;
    }
    for (int child = 0; child < node.child_count; ++child) {
      if (node.is_inner(child)) continue;
      const Box box = box_of_leaf<Box>(node, child, positions, arrays, first, leaves);
      all_finite = box.all_finite() && all_finite;
      set_child(children, child, box);
    }
    unite_children(nodes, boxes, n);
  }
  return all_finite || arrays.inert != nullptr;
}

bool RefitBoxes(const OctreeNode* nodes, ChildBoxes* boxes, const TriangleArrays& arrays,
                const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end) {
  return arrays.doubles.data != nullptr
             ? refit_nodes<DoubleBox>(nodes, boxes, arrays.doubles, arrays, leaves, begin, end)
             : refit_nodes<FloatBox>(nodes, boxes, arrays.floats, arrays, leaves, begin, end);
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(RefitBoxes);

bool refit_boxes(const OctreeNode* nodes, ChildBoxes* boxes, const TriangleArrays& arrays,
                 const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end) {
  return HWY_DYNAMIC_DISPATCH(RefitBoxes)(nodes, boxes, arrays, leaves, begin, end);
}

}  // namespace supple
#endif
