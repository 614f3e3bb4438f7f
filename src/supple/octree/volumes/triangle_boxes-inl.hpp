// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_OCTREE_TRIANGLE_BOXES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_OCTREE_TRIANGLE_BOXES_INL_HPP
#undef SUPPLE_OCTREE_TRIANGLE_BOXES_INL_HPP
#else
#define SUPPLE_OCTREE_TRIANGLE_BOXES_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/float_rounding.hpp"
#include "mesh/vertex_loads-inl.hpp"
#include "octree/volumes/box_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

/// The scalar version of the boxes below, for machines without vectors.
template <class Scalar>
struct ScalarBox {
  static constexpr Scalar inf = std::numeric_limits<Scalar>::infinity();
  Scalar lo[3] = {inf, inf, inf}, hi[3] = {-inf, -inf, -inf};
  Scalar sum = 0;

  void extend(const Scalar* vertex) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], vertex[axis]);
      hi[axis] = std::max(hi[axis], vertex[axis]);
      sum += vertex[axis];
    }
  }
  void extend(const Scalar* lower, const Scalar* upper) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], lower[axis]);
      hi[axis] = std::max(hi[axis], upper[axis]);
    }
  }
  void extend(const ScalarBox& other) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], other.lo[axis]);
      hi[axis] = std::max(hi[axis], other.hi[axis]);
    }
    sum += other.sum;
  }
  bool all_finite() const { return sum - sum == 0; }
  void store(float* lower, float* upper) const {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = round_down(lo[axis]);
      upper[axis] = round_up(hi[axis]);
    }
  }
};
using FloatBox = ScalarBox<float>;
using DoubleBox = ScalarBox<double>;

#else

/// A box that grows; x y z are the first three of four vector lanes.
struct FloatBox {
  using Tag = hn::FixedTag<float, 4>;
  hn::Vec<Tag> lo, hi, sum;

  // Explicit: compilers would not apply this function's instruction set to an implicit constructor.
  HWY_INLINE FloatBox()
      : lo(hn::Set(Tag(), std::numeric_limits<float>::infinity())),
        hi(hn::Set(Tag(), -std::numeric_limits<float>::infinity())),
        sum(hn::Zero(Tag())) {}

  HWY_INLINE void extend(const float* vertex) {
    const auto v = load_vertex(vertex);
    lo = hn::Min(lo, v);
    hi = hn::Max(hi, v);
    sum = hn::Add(sum, v);
  }
  /// By a box. The float after each corner must be readable; `all_finite` ignores the box.
  HWY_INLINE void extend(const float* lower, const float* upper) {
    lo = hn::Min(lo, hn::LoadU(Tag(), lower));
    hi = hn::Max(hi, hn::LoadU(Tag(), upper));
  }
  HWY_INLINE void extend(const FloatBox& other) {
    lo = hn::Min(lo, other.lo);
    hi = hn::Max(hi, other.hi);
    sum = hn::Add(sum, other.sum);
  }
  /// False when a coordinate is not finite, or their sum overflows.
  HWY_INLINE bool all_finite() const {
    return hn::AllTrue(Tag(), hn::Eq(hn::Sub(sum, sum), hn::Zero(Tag())));
  }
  HWY_INLINE hn::Vec<Tag> lower() const { return lo; }
  HWY_INLINE hn::Vec<Tag> upper() const { return hi; }
  HWY_INLINE void store(float* HWY_RESTRICT lower, float* HWY_RESTRICT upper) const {
    hn::StoreU(lo, Tag(), lower);
    hn::StoreU(hi, Tag(), upper);
  }
};

/// The same for doubles, rounded outward once at the end.
struct DoubleBox {
  using Tag = hn::FixedTag<double, 2>;
  using FloatTag = hn::FixedTag<float, 2>;
  static constexpr double inf = std::numeric_limits<double>::infinity();
  hn::Vec<Tag> lo_xy, lo_z, hi_xy, hi_z, sum;

  HWY_INLINE DoubleBox()
      : lo_xy(hn::Set(Tag(), inf)),
        lo_z(hn::Set(Tag(), inf)),
        hi_xy(hn::Set(Tag(), -inf)),
        hi_z(hn::Set(Tag(), -inf)),
        sum(hn::Zero(Tag())) {}

  HWY_INLINE void extend(const double* vertex) {
    const auto xy = hn::LoadU(Tag(), vertex);
    const auto z = hn::Set(Tag(), vertex[2]);
    sum = hn::Add(sum, hn::Add(xy, z));
    lo_xy = hn::Min(lo_xy, xy);
    hi_xy = hn::Max(hi_xy, xy);
    lo_z = hn::Min(lo_z, z);
    hi_z = hn::Max(hi_z, z);
  }
  HWY_INLINE void extend(const DoubleBox& other) {
    lo_xy = hn::Min(lo_xy, other.lo_xy);
    lo_z = hn::Min(lo_z, other.lo_z);
    hi_xy = hn::Max(hi_xy, other.hi_xy);
    hi_z = hn::Max(hi_z, other.hi_z);
    sum = hn::Add(sum, other.sum);
  }
  HWY_INLINE bool all_finite() const {
    return hn::AllTrue(Tag(), hn::Eq(hn::Sub(sum, sum), hn::Zero(Tag())));
  }
  HWY_INLINE hn::Vec<FloatBox::Tag> lower() const {
    return hn::Combine(FloatBox::Tag(), round_down(lo_z), round_down(lo_xy));
  }
  HWY_INLINE hn::Vec<FloatBox::Tag> upper() const {
    return hn::Combine(FloatBox::Tag(), round_up(hi_z), round_up(hi_xy));
  }
  HWY_INLINE void store(float* HWY_RESTRICT lower, float* HWY_RESTRICT upper) const {
    hn::StoreU(round_down(lo_xy), FloatTag(), lower);
    hn::StoreU(round_down(lo_z), FloatTag(), lower + 2);
    hn::StoreU(round_up(hi_xy), FloatTag(), upper);
    hn::StoreU(round_up(hi_z), FloatTag(), upper + 2);
  }

 private:
  // As `round_down` and `round_up` of core/float_rounding.hpp.
  static HWY_INLINE hn::Vec<FloatTag> round_down(hn::Vec<Tag> v) {
    const FloatTag f32;
    const auto nearest = hn::Min(hn::DemoteTo(f32, v), hn::Set(f32, std::numeric_limits<float>::max()));
    const auto too_high = hn::Gt(hn::PromoteTo(Tag(), nearest), v);
    const auto step = outward_step(nearest);
    return hn::IfThenElse(demote_mask(too_high), hn::Sub(nearest, step), nearest);
  }
  static HWY_INLINE hn::Vec<FloatTag> round_up(hn::Vec<Tag> v) {
    const FloatTag f32;
    const auto nearest = hn::Max(hn::DemoteTo(f32, v), hn::Set(f32, -std::numeric_limits<float>::max()));
    const auto too_low = hn::Lt(hn::PromoteTo(Tag(), nearest), v);
    const auto step = outward_step(nearest);
    return hn::IfThenElse(demote_mask(too_low), hn::Add(nearest, step), nearest);
  }
  static HWY_INLINE hn::Vec<FloatTag> outward_step(hn::Vec<FloatTag> v) {
    const FloatTag f32;
    return hn::Add(hn::Mul(hn::Abs(v), hn::Set(f32, 0x1p-23f)),
                   hn::Set(f32, std::numeric_limits<float>::min()));
  }
  static HWY_INLINE hn::Mask<FloatTag> demote_mask(hn::Mask<Tag> mask) {
    const FloatTag f32;
    const auto one_or_zero = hn::IfThenElseZero(mask, hn::Set(Tag(), 1.0));
    return hn::Gt(hn::DemoteTo(f32, one_or_zero), hn::Zero(f32));
  }
};

#endif

template <class Box, class Scalar>
HWY_INLINE void extend_by_triangle(Box& box, VertexArray<Scalar> positions, const Triangle& triangle) {
  box.extend(positions[triangle[0]]);
  box.extend(positions[triangle[1]]);
  box.extend(positions[triangle[2]]);
}

/// Sets the box of a child.
template <class Box>
HWY_INLINE void set_child(ChildBoxes& children, int child, const Box& box) {
  HWY_ALIGN float lower[4], upper[4];
  box.store(lower, upper);
  set_child_box(children, child, {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}});
}

#if HWY_TARGET != HWY_SCALAR

/// x y z of four corners become four x, four y and four z.
HWY_INLINE void store_transposed(hn::Vec<FloatBox::Tag> p, hn::Vec<FloatBox::Tag> q, hn::Vec<FloatBox::Tag> r,
                                 hn::Vec<FloatBox::Tag> s, float* x, float* y, float* z) {
  const FloatBox::Tag tag;
  const auto xy_pq = hn::InterleaveLower(tag, p, q), xy_rs = hn::InterleaveLower(tag, r, s);
  const auto z_pq = hn::InterleaveUpper(tag, p, q), z_rs = hn::InterleaveUpper(tag, r, s);
  hn::StoreU(hn::ConcatLowerLower(tag, xy_rs, xy_pq), tag, x);
  hn::StoreU(hn::ConcatUpperUpper(tag, xy_rs, xy_pq), tag, y);
  hn::StoreU(hn::ConcatLowerLower(tag, z_rs, z_pq), tag, z);
}

#endif

/// Boxes `first` to `first` + 3 of six arrays (min x, y, z, max x, y, z) become the given ones.
template <class Box, class Arrays>
HWY_INLINE void store_four_boxes(const Box (&boxes)[4], Arrays& arrays, std::size_t first) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t i = 0; i < 4; ++i) {
    float lower[3], upper[3];
    boxes[i].store(lower, upper);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      arrays[axis][first + i] = lower[axis];
      arrays[axis + 3][first + i] = upper[axis];
    }
  }
#else
  store_transposed(boxes[0].lower(), boxes[1].lower(), boxes[2].lower(), boxes[3].lower(), arrays[0] + first,
                   arrays[1] + first, arrays[2] + first);
  store_transposed(boxes[0].upper(), boxes[1].upper(), boxes[2].upper(), boxes[3].upper(), arrays[3] + first,
                   arrays[4] + first, arrays[5] + first);
#endif
}

template <class Boxes, class Box>
HWY_INLINE void set_four_boxes(Boxes& all, std::size_t first, const Box (&boxes)[4]) {
  float* const arrays[] = {all.min_x, all.min_y, all.min_z, all.max_x, all.max_y, all.max_z};
  store_four_boxes(boxes, arrays, first);
}

HWY_INLINE void invert_children_from(ChildBoxes& children, int first) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  for (int child = first; child < node_width; ++child) {
    children.min_x[child] = children.min_y[child] = children.min_z[child] = inf;
    children.max_x[child] = children.max_y[child] = children.max_z[child] = -inf;
  }
}

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

HWY_INLINE Aabb enclose_children(const ChildBoxes& children) {
  return {{min_of_eight(children.min_x), min_of_eight(children.min_y), min_of_eight(children.min_z)},
          {max_of_eight(children.max_x), max_of_eight(children.max_y), max_of_eight(children.max_z)}};
}

/// Inverts the boxes of missing children and writes the box of all children into the parent.
HWY_INLINE void unite_children(const OctreeNode* nodes, ChildBoxes* boxes, std::uint32_t n) {
  const OctreeNode& node = nodes[n];
  invert_children_from(boxes[n], node.child_count);
  if (node.parent == n) return;
  const Aabb box = enclose_children(boxes[n]);
  set_child_box(boxes[node.parent], node.index_in_parent, box);
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
