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
HWY_INLINE void set_box(const VertexCorners& corners, const Ids& ids, const BoxArrays& boxes,
                        std::size_t element) {
  const std::size_t first = ids.vertex(element, 0) * corners.step;
  for (int axis = 0; axis < 3; ++axis) {
    float low = corners.lower[first + static_cast<std::size_t>(axis)];
    float high = corners.upper[first + static_cast<std::size_t>(axis)];
    for (int corner = 1; corner < Ids::corner_count; ++corner) {
      const std::size_t at = ids.vertex(element, corner) * corners.step + static_cast<std::size_t>(axis);
      low = std::min(low, corners.lower[at]);
      high = std::max(high, corners.upper[at]);
    }
    boxes.at(axis, element) = low;
    boxes.at(axis + 3, element) = high;
  }
}

#if HWY_TARGET != HWY_SCALAR

using FourFloats = hn::FixedTag<float, 4>;

template <class Ids>
HWY_INLINE hn::Vec<FourFloats> lower_corner(const VertexCorners& corners, const Ids& ids,
                                            std::size_t element) {
  const FourFloats tag;
  auto low = hn::LoadU(tag, corners.lower + ids.vertex(element, 0) * corners.step);
  for (int corner = 1; corner < Ids::corner_count; ++corner) {
    low = hn::Min(low, hn::LoadU(tag, corners.lower + ids.vertex(element, corner) * corners.step));
  }
  return low;
}

template <class Ids>
HWY_INLINE hn::Vec<FourFloats> upper_corner(const VertexCorners& corners, const Ids& ids,
                                            std::size_t element) {
  const FourFloats tag;
  auto high = hn::LoadU(tag, corners.upper + ids.vertex(element, 0) * corners.step);
  for (int corner = 1; corner < Ids::corner_count; ++corner) {
    high = hn::Max(high, hn::LoadU(tag, corners.upper + ids.vertex(element, corner) * corners.step));
  }
  return high;
}

/// Four points, x y z each, into three arrays.
HWY_INLINE void store_transposed(hn::Vec<FourFloats> p, hn::Vec<FourFloats> q, hn::Vec<FourFloats> r,
                                 hn::Vec<FourFloats> s, float* x, std::size_t stride) {
  const FourFloats tag;
  const auto xy_pq = hn::InterleaveLower(tag, p, q), xy_rs = hn::InterleaveLower(tag, r, s);
  const auto z_pq = hn::InterleaveUpper(tag, p, q), z_rs = hn::InterleaveUpper(tag, r, s);
  hn::StoreU(hn::ConcatLowerLower(tag, xy_rs, xy_pq), tag, x);
  hn::StoreU(hn::ConcatUpperUpper(tag, xy_rs, xy_pq), tag, x + stride);
  hn::StoreU(hn::ConcatLowerLower(tag, z_rs, z_pq), tag, x + 2 * stride);
}

template <class Ids>
HWY_INLINE void set_four_boxes(const VertexCorners& corners, const Ids& ids, const BoxArrays& boxes,
                               std::size_t i) {
  store_transposed(lower_corner(corners, ids, i), lower_corner(corners, ids, i + 1),
                   lower_corner(corners, ids, i + 2), lower_corner(corners, ids, i + 3), &boxes.at(0, i),
                   boxes.stride);
  store_transposed(upper_corner(corners, ids, i), upper_corner(corners, ids, i + 1),
                   upper_corner(corners, ids, i + 2), upper_corner(corners, ids, i + 3), &boxes.at(3, i),
                   boxes.stride);
}

#endif

template <class Ids>
HWY_INLINE void set_boxes(const VertexCorners& corners, const Ids& ids, const BoxArrays& boxes,
                          std::size_t begin, std::size_t end) {
  std::size_t i = begin;
#if HWY_TARGET != HWY_SCALAR
  for (; i + 4 <= end; i += 4) set_four_boxes(corners, ids, boxes, i);
#endif
  for (; i < end; ++i) set_box(corners, ids, boxes, i);
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

/// Grows with ranges of elements. Whole vectors: a side of a box is reduced to one number only at the end.
class ElementUnion {
 public:
  HWY_INLINE void extend(const BoxArrays& boxes, std::uint32_t begin, std::uint32_t end) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const LanesTag tag;
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
  HWY_INLINE void store(AabbLanes& lanes, int lane) const {
    const LanesTag tag;
    float lower[3], upper[3];
    for (int side = 0; side < 3; ++side) {
      lower[side] = hn::GetLane(hn::MinOfLanes(tag, hn::Load(tag, sides_[side])));
      upper[side] = hn::GetLane(hn::MaxOfLanes(tag, hn::Load(tag, sides_[side + 3])));
    }
    set_lane(lanes, lane, lower, upper);
  }
  HWY_INLINE ElementUnion() {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const LanesTag tag;
    for (int side = 0; side < 3; ++side) {
      hn::Store(hn::Set(tag, inf), tag, sides_[side]);
      hn::Store(hn::Set(tag, -inf), tag, sides_[side + 3]);
    }
  }

 private:
  using LanesTag = hn::CappedTag<float, node_width>;
  HWY_ALIGN float sides_[6][node_width];
};

void RefitElementBoxes(const OctreeNode* nodes, AabbLanes* boxes, const LeafElements& elements,
                       std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t n = begin; n < end; ++n) {
    const OctreeNode& node = nodes[n];
    AabbLanes& lanes = boxes[n];
    for (int lane = 0; lane < node.lane_count; ++lane) {
      if (node.is_inner(lane)) continue;
      const std::uint32_t first = node.first_triangle[lane], last = node.first_triangle[lane + 1];
      ElementUnion all;
      all.extend(elements.faces, first, last);
      if (!elements.faces_enclose) {
        all.extend(elements.edges, elements.first_edge[first], elements.first_edge[last]);
        all.extend(elements.vertices, elements.first_vertex[first], elements.first_vertex[last]);
      }
      all.store(lanes, lane);
    }
    invert_lanes_from(lanes, node.lane_count);
    if (node.parent == n) continue;
    const Aabb box = enclose_lanes(lanes);
    set_lane(boxes[node.parent], node.parent_lane, &box.min.x, &box.max.x);
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

void refit_element_boxes(const OctreeNode* nodes, AabbLanes* boxes, const LeafElements& elements,
                         std::uint32_t begin, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(RefitElementBoxes)(nodes, boxes, elements, begin, end);
}

}  // namespace supple
#endif
