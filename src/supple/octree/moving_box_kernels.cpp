#include "octree/moving_box_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/moving_box_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "octree/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

/// Vertices of elements: `vertex(element, corner)`.
struct VerticesThemselves {
  static constexpr int corner_count = 1;
  HWY_INLINE std::size_t vertex(std::size_t element, int) const { return element; }
};
template <int corners>
struct VerticesOfElements {
  static constexpr int corner_count = corners;
  const std::array<std::uint32_t, corners>* ids;
  HWY_INLINE std::size_t vertex(std::size_t element, int corner) const {
    return ids[element][static_cast<std::size_t>(corner)];
  }
};

template <class Ids>
HWY_INLINE FloatBox element_box(const VertexCorners& corners, const Ids& ids, std::size_t element) {
  FloatBox box;
  for (int corner = 0; corner < Ids::corner_count; ++corner) {
    const std::size_t at = ids.vertex(element, corner) * corners.step;
    box.extend(corners.lower + at, corners.upper + at);
  }
  return box;
}

template <class Ids>
HWY_INLINE void set_boxes(const VertexCorners& corners, const Ids& ids, const BoxArrays& boxes,
                          std::size_t begin, std::size_t end) {
  std::size_t i = begin;
#if HWY_TARGET != HWY_SCALAR
  for (; i + 4 <= end; i += 4) {
    const FloatBox p = element_box(corners, ids, i), q = element_box(corners, ids, i + 1),
                   r = element_box(corners, ids, i + 2), s = element_box(corners, ids, i + 3);
    store_transposed(p.lower(), q.lower(), r.lower(), s.lower(), &boxes.at(0, i), &boxes.at(1, i),
                     &boxes.at(2, i));
    store_transposed(p.upper(), q.upper(), r.upper(), s.upper(), &boxes.at(3, i), &boxes.at(4, i),
                     &boxes.at(5, i));
  }
#endif
  for (; i < end; ++i) {
    HWY_ALIGN float lower[4], upper[4];
    element_box(corners, ids, i).store(lower, upper);
    for (int axis = 0; axis < 3; ++axis) {
      boxes.at(axis, i) = lower[axis];
      boxes.at(axis + 3, i) = upper[axis];
    }
  }
}

void VertexBoxes(const VertexCorners& corners, const BoxArrays& boxes, std::uint32_t begin,
                 std::uint32_t end) {
  set_boxes(corners, VerticesThemselves{}, boxes, begin, end);
}

void EdgeBoxes(const VertexCorners& corners, const Edge* edges, const BoxArrays& boxes, std::uint32_t begin,
               std::uint32_t end) {
  set_boxes(corners, VerticesOfElements<2>{edges}, boxes, begin, end);
}

void FaceBoxes(const VertexCorners& corners, const Triangle* faces, const BoxArrays& boxes,
               std::uint32_t begin, std::uint32_t end) {
  set_boxes(corners, VerticesOfElements<3>{faces}, boxes, begin, end);
}

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

/// The box around ranges of elements. Keeps vectors and reduces each side to one number only at the end.
class ElementUnion {
 public:
  HWY_INLINE void extend(const BoxArrays& boxes, std::uint32_t begin, std::uint32_t end) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const BoxTag tag;
    const auto none = hn::Set(tag, inf);
    for (std::size_t i = begin; i < end; i += hn::Lanes(tag)) {
      const auto valid = hn::FirstN(tag, std::min<std::size_t>(end - i, hn::Lanes(tag)));
      for (int side = 0; side < 3; ++side) {
        float* const low = sides_[side];
        float* const high = sides_[side + 3];
        const auto l = hn::IfThenElse(valid, hn::LoadU(tag, &boxes.at(side, i)), none);
        const auto h = hn::IfThenElse(valid, hn::LoadU(tag, &boxes.at(side + 3, i)), hn::Neg(none));
        hn::Store(hn::Min(hn::Load(tag, low), l), tag, low);
        hn::Store(hn::Max(hn::Load(tag, high), h), tag, high);
      }
    }
  }
  HWY_INLINE void store(ChildBoxes& children, int child) const {
    const BoxTag tag;
    float lower[3], upper[3];
    for (int side = 0; side < 3; ++side) {
      lower[side] = hn::GetLane(hn::MinOfLanes(tag, hn::Load(tag, sides_[side])));
      upper[side] = hn::GetLane(hn::MaxOfLanes(tag, hn::Load(tag, sides_[side + 3])));
    }
    set_child(children, child, lower, upper);
  }
  HWY_INLINE ElementUnion() {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const BoxTag tag;
    for (int side = 0; side < 3; ++side) {
      hn::Store(hn::Set(tag, inf), tag, sides_[side]);
      hn::Store(hn::Set(tag, -inf), tag, sides_[side + 3]);
    }
  }

 private:
  using BoxTag = hn::CappedTag<float, node_width>;
  HWY_ALIGN float sides_[6][node_width];
};

void RefitElementBoxes(const OctreeNode* nodes, ChildBoxes* boxes, const LeafElements& elements,
                       std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t n = begin; n < end; ++n) {
    const OctreeNode& node = nodes[n];
    ChildBoxes& children = boxes[n];
    for (int child = 0; child < node.child_count; ++child) {
      if (node.is_inner(child)) continue;
      const std::uint32_t first = node.first_triangle[child], last = node.first_triangle[child + 1];
      ElementUnion all;
      all.extend(elements.faces, first, last);
      if (!elements.faces_enclose) {
        all.extend(elements.edges, elements.first_edge[first], elements.first_edge[last]);
        all.extend(elements.vertices, elements.first_vertex[first], elements.first_vertex[last]);
      }
      all.store(children, child);
    }
    invert_children_from(children, node.child_count);
    if (node.parent == n) continue;
    const Aabb box = enclose_children(children);
    set_child(boxes[node.parent], node.index_in_parent, &box.min.x, &box.max.x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(RoundCorners);
HWY_EXPORT(VertexBoxes);
HWY_EXPORT(EdgeBoxes);
HWY_EXPORT(FaceBoxes);
HWY_EXPORT(RefitElementBoxes);

void round_corners(const double* vertices, float* corners, std::uint32_t begin, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(RoundCorners)(vertices, corners, begin, end);
}

void set_vertex_boxes(const VertexCorners& corners, const BoxArrays& boxes, std::uint32_t begin,
                      std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(VertexBoxes)(corners, boxes, begin, end);
}

void set_edge_boxes(const VertexCorners& corners, const Edge* edges, const BoxArrays& boxes,
                    std::uint32_t begin, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(EdgeBoxes)(corners, edges, boxes, begin, end);
}

void set_face_boxes(const VertexCorners& corners, const Triangle* faces, const BoxArrays& boxes,
                    std::uint32_t begin, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(FaceBoxes)(corners, faces, boxes, begin, end);
}

void refit_element_boxes(const OctreeNode* nodes, ChildBoxes* boxes, const LeafElements& elements,
                         std::uint32_t begin, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(RefitElementBoxes)(nodes, boxes, elements, begin, end);
}

}  // namespace supple
#endif
