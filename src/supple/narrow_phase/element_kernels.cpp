#include "narrow_phase/element_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "narrow_phase/element_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "core/float_rounding.hpp"
#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One box at both ends of the step: min x, y, z, max x, y, z.
struct MovingBox {
  float start[6], end[6];
};

HWY_INLINE void load_box(float* box, const float* boxes, std::size_t stride, std::size_t i) {
  for (std::size_t side = 0; side < 6; ++side) box[side] = boxes[side * stride + i];
}

/// Grows the box by at least the separation. Bounds stay within the range of float. Inverted boxes stay
/// inverted, so that they overlap no other box.
HWY_INLINE void grow(float* box, float separation) {
  constexpr float greatest = std::numeric_limits<float>::max();
  if (box[0] > greatest) return;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = box[axis] - separation, high = box[axis + 3] + separation;
    box[axis] = std::max(low - outward_step(low), -greatest);
    box[axis + 3] = std::min(high + outward_step(high), greatest);
  }
}

/// Bounds at a time between the two ends of the step. They are farther out, in the direction `outward` (-1 or
/// 1), than any rounding error. They stay within the range of float, so that an inverted box stays inverted.
template <class Tag, class Vector = hn::Vec<Tag>>
HWY_INLINE Vector between(Tag tag, Vector start, Vector end, float time, float outward) {
  constexpr float greatest = std::numeric_limits<float>::max();
  const Vector sizes = hn::Add(hn::Abs(start), hn::Abs(end));
  const Vector slack = hn::Min(hn::Mul(hn::Set(tag, 0x1p-21f), sizes), hn::Set(tag, greatest / 4));
  const Vector bound = hn::Add(hn::Mul(start, hn::Set(tag, 1 - time)), hn::Mul(end, hn::Set(tag, time)));
  const Vector moved =
      hn::Add(bound, hn::Mul(hn::Set(tag, outward), hn::Add(slack, hn::Set(tag, 0x1p-120f))));
  return hn::Min(hn::Max(moved, hn::Set(tag, -greatest)), hn::Set(tag, greatest));
}

/// Moves the box by the offset, or back. Inverted boxes stay inverted.
HWY_INLINE void shift(float* box, const Vec3f& offset, float sign) {
  for (int axis = 0; axis < 3; ++axis) {
    box[axis] += sign * offset[axis];
    box[axis + 3] += sign * offset[axis];
  }
}

enum class Side { a, b };

/// The box of an element of a, moved to where the boxes of b are stored, or the reverse.
template <Side of>
HWY_NOINLINE MovingBox moving_box(const MovingBoxArrays& arrays, std::size_t i, const PartOfStep& part) {
  MovingBox box;
  load_box(box.start, arrays.start, arrays.stride, i);
  load_box(box.end, arrays.end, arrays.stride, i);
  if (!(part.offset == Vec3f{})) {
    shift(box.start, part.offset, of == Side::a ? -1.0f : 1.0f);
    shift(box.end, part.offset, of == Side::a ? -1.0f : 1.0f);
  }
  if (part.separation > 0) {
    grow(box.start, part.separation);
    grow(box.end, part.separation);
  }
  if (part.latest < 1) {
    const hn::CappedTag<float, 1> one;
    for (std::size_t side = 0; side < 6; ++side) {
      box.end[side] = hn::GetLane(between(one, hn::Set(one, box.start[side]), hn::Set(one, box.end[side]),
                                          part.latest, side < 3 ? -1.0f : 1.0f));
    }
  }
  return box;
}

HWY_INLINE MovingBoxArrays child_boxes(const MovingView& view, std::uint32_t node) {
  return {view.start[node].min_x, view.end[node].min_x, node_width};
}

/// Whether a vector of boxes, from `first` on, is apart from `box` along the axis: on the same side at both
/// ends of the part of the step.
template <class Tag>
HWY_INLINE hn::Mask<Tag> apart_along(Tag tag, const MovingBox& box, const MovingBoxArrays& arrays,
                                     std::size_t first, std::size_t axis, float latest) {
  const float* const start = arrays.start + axis * arrays.stride + first;
  const float* const end = arrays.end + axis * arrays.stride + first;
  const std::size_t to_max = 3 * arrays.stride;
  const auto start_min = hn::LoadU(tag, start), start_max = hn::LoadU(tag, start + to_max);
  auto end_min = hn::LoadU(tag, end), end_max = hn::LoadU(tag, end + to_max);
  if (latest < 1) {
    end_min = between(tag, start_min, end_min, latest, -1.0f);
    end_max = between(tag, start_max, end_max, latest, 1.0f);
  }
  const auto above = hn::And(hn::Gt(start_min, hn::Set(tag, box.start[axis + 3])),
                             hn::Gt(end_min, hn::Set(tag, box.end[axis + 3])));
  const auto below =
      hn::And(hn::Lt(start_max, hn::Set(tag, box.start[axis])), hn::Lt(end_max, hn::Set(tag, box.end[axis])));
  return hn::Or(above, below);
}

/// Bits of a vector of boxes, from `first` on, that are not apart from `box` along any axis.
template <class Tag>
HWY_INLINE std::uint64_t meeting_bits(Tag tag, const MovingBox& box, const MovingBoxArrays& arrays,
                                      std::size_t first, float latest) {
  const auto apart = hn::Or(apart_along(tag, box, arrays, first, 0, latest),
                            hn::Or(apart_along(tag, box, arrays, first, 1, latest),
                                   apart_along(tag, box, arrays, first, 2, latest)));
  return mask_bits(tag, hn::Not(apart));
}

/// Bits of the boxes of a range of at most 64 elements that are not apart from `box`; bits past the range are
/// unspecified. Not inlined, because compilers would take minutes.
HWY_NOINLINE std::uint64_t meeting_elements(const MovingBox& box, const MovingBoxArrays& boxes,
                                            ElementRange range, float latest) {
  const hn::CappedTag<float, 16> tag;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(tag));
  std::uint64_t bits = meeting_bits(tag, box, boxes, range.begin, latest);
  for (std::uint32_t j = lanes; j < range.size(); j += lanes) {
    bits |= meeting_bits(tag, box, boxes, range.begin + j, latest) << j;
  }
  return bits;
}

void MovingOverlapMasks(const NodePair* pairs, std::size_t count, const MovingView& a, const MovingView& b,
                        const PartOfStep& part, std::uint64_t* masks) {
  const hn::CappedTag<float, node_width> tag;
  for (std::size_t k = 0; k < count; ++k) {
    const MovingBoxArrays boxes_a = child_boxes(a, pairs[k].a), boxes_b = child_boxes(b, pairs[k].b);
    std::uint64_t mask = 0;
    for (std::uint32_t rest = pairs[k].children_a; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const MovingBox box = moving_box<Side::a>(boxes_a, i, part);
      for (std::size_t j = 0; j < node_width; j += hn::Lanes(tag)) {
        mask |= meeting_bits(tag, box, boxes_b, j, part.latest) << (8 * i + j);
      }
    }
    masks[k] = mask;
  }
}

/// One call of `find_element_box_pairs`.
class ElementTests {
 public:
  ElementTests(const MovingView& a, const MovingView& b, const PartOfStep& part, bool same_object,
               ElementPairBatches& batches)
      : a_(a), b_(b), part_(part), same_object_(same_object), batches_(batches) {}

  void test(const LeafPair& leaves) {
    same_leaf_ = same_object_ && leaves.begin_a == leaves.begin_b;
    box_a_ =
        moving_box<Side::a>(child_boxes(a_, leaves.leaf_a / node_width), leaves.leaf_a % node_width, part_);
    box_b_ =
        moving_box<Side::b>(child_boxes(b_, leaves.leaf_b / node_width), leaves.leaf_b % node_width, part_);
    const ElementRange vertices_a{a_.first_vertex[leaves.begin_a], a_.first_vertex[leaves.end_a]};
    const ElementRange vertices_b{b_.first_vertex[leaves.begin_b], b_.first_vertex[leaves.end_b]};
    const ElementRange faces_a{leaves.begin_a, leaves.end_a}, faces_b{leaves.begin_b, leaves.end_b};
    match<Kind::vertex_face>(a_.vertices, vertices_a, b_.faces, faces_b);
    if (!same_leaf_) match<Kind::face_vertex>(a_.faces, faces_a, b_.vertices, vertices_b);
    match<Kind::edge_edge>(a_.edges, {a_.first_edge[leaves.begin_a], a_.first_edge[leaves.end_a]}, b_.edges,
                           {b_.first_edge[leaves.begin_b], b_.first_edge[leaves.end_b]});
  }
  std::uint64_t box_tests() const { return tests_; }

 private:
  using Kind = ElementPairKind;
  /// Elements in one test, one bit for each. The same on all instruction sets, so the order of pairs is too.
  static constexpr std::uint32_t block = 64;

  template <Kind kind>
  void match(const MovingBoxArrays& boxes_a, ElementRange range_a, const MovingBoxArrays& boxes_b,
             ElementRange range_b) {
    for (std::uint32_t a = range_a.begin; a < range_a.end; a += block) {
      const ElementRange part_a{a, std::min(a + block, range_a.end)};
      const std::uint64_t near_b = near_leaf(box_b_, boxes_a, part_a);
      if (near_b == 0) continue;
      // Avoids finding each pair of edges of one leaf twice.
      const bool half = kind == Kind::edge_edge && same_leaf_;
      for (std::uint32_t b = half ? a : range_b.begin; b < range_b.end; b += block) {
        const ElementRange part_b{b, std::min(b + block, range_b.end)};
        const std::uint64_t near_a = near_leaf(box_a_, boxes_b, part_b);
        if (near_a != 0) match_blocks<kind>(boxes_a, part_a, near_b, boxes_b, part_b, near_a);
      }
    }
  }

  /// Bits of the elements that may come near the other leaf.
  std::uint64_t near_leaf(const MovingBox& leaf, const MovingBoxArrays& boxes, ElementRange range) {
    const std::uint64_t all = ~std::uint64_t{0} >> (block - range.size());
    return same_leaf_ ? all : meeting(leaf, boxes, range) & all;
  }

  std::uint64_t meeting(const MovingBox& box, const MovingBoxArrays& boxes, ElementRange range) {
    tests_ += range.size();
    return meeting_elements(box, boxes, range, part_.latest);
  }

  /// Tests each element of the side that has fewer against the other side.
  template <Kind kind>
  void match_blocks(const MovingBoxArrays& boxes_a, ElementRange range_a, std::uint64_t some_a,
                    const MovingBoxArrays& boxes_b, ElementRange range_b, std::uint64_t some_b) {
    const bool one_block = kind == Kind::edge_edge && same_leaf_ && range_a.begin == range_b.begin;
    if (one_block || std::popcount(some_a) <= std::popcount(some_b)) {
      for (; some_a != 0; some_a &= some_a - 1) {
        if (one_block) some_b = some_a & (some_a - 1);
        const std::uint32_t a = range_a.begin + static_cast<std::uint32_t>(std::countr_zero(some_a));
        const std::uint64_t hits = meeting(moving_box<Side::a>(boxes_a, a, part_), boxes_b, range_b);
        add<kind, false>(a, range_b.begin, hits & some_b);
      }
      return;
    }
    for (; some_b != 0; some_b &= some_b - 1) {
      const std::uint32_t b = range_b.begin + static_cast<std::uint32_t>(std::countr_zero(some_b));
      const std::uint64_t hits = meeting(moving_box<Side::b>(boxes_b, b, part_), boxes_a, range_a);
      add<kind, true>(b, range_a.begin, hits & some_a);
    }
  }

  /// Adds pairs of the element `one` of a, or of b with `of_b`, and the elements of the other object in
  /// `hits`, counted from `first`.
  template <Kind kind, bool of_b>
  void add(std::uint32_t one, std::uint32_t first, std::uint64_t hits) {
    if (hits == 0) return;
    // In pairs within one object the vertex comes first.
    const bool turned = same_object_ && kind == Kind::face_vertex;
    const Kind reported = turned ? Kind::vertex_face : kind;
    ElementPair* const pairs = batches_.room_for(reported, block);
    std::size_t count = 0;
    for (; hits != 0; hits &= hits - 1) {
      const std::uint32_t other = first + static_cast<std::uint32_t>(std::countr_zero(hits));
      pairs[count] = turned != of_b ? ElementPair{other, one} : ElementPair{one, other};
      // Adds instead of branching, because this branch is hard to predict.
      count += same_object_ && share_vertex<kind, of_b>(one, other) ? 0u : 1u;
    }
    batches_.added(reported, count);
  }

  template <Kind kind, bool of_b>
  HWY_INLINE bool share_vertex(std::uint32_t one, std::uint32_t other) const {
    const auto same = [](std::uint32_t p, std::uint32_t q) { return p == q ? 1u : 0u; };
    if constexpr (kind == Kind::edge_edge) {
      const Edge &p = a_.edge_ids[one], &q = a_.edge_ids[other];
      return (same(p[0], q[0]) | same(p[0], q[1]) | same(p[1], q[0]) | same(p[1], q[1])) != 0;
    } else {
      constexpr bool one_is_vertex = (kind == Kind::vertex_face) != of_b;
      const std::uint32_t vertex = one_is_vertex ? one : other;
      const Triangle& corners = a_.face_ids[one_is_vertex ? other : one];
      return (same(corners[0], vertex) | same(corners[1], vertex) | same(corners[2], vertex)) != 0;
    }
  }

  const MovingView& a_;
  const MovingView& b_;
  PartOfStep part_;
  bool same_object_;
  ElementPairBatches& batches_;
  bool same_leaf_ = false;
  MovingBox box_a_, box_b_;
  std::uint64_t tests_ = 0;
};

std::uint64_t ElementBoxPairs(const LeafPair* leaf_pairs, std::size_t count, const MovingView& a,
                              const MovingView& b, const PartOfStep& part, bool same_object,
                              ElementPairBatches& batches) {
  ElementTests tests(a, b, part, same_object, batches);
  for (std::size_t k = 0; k < count; ++k) tests.test(leaf_pairs[k]);
  return tests.box_tests();
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(MovingOverlapMasks);
HWY_EXPORT(ElementBoxPairs);

void moving_overlap_masks(std::span<const NodePair> pairs, const MovingView& a, const MovingView& b,
                          const PartOfStep& part, std::uint64_t* masks) {
  HWY_DYNAMIC_DISPATCH(MovingOverlapMasks)(pairs.data(), pairs.size(), a, b, part, masks);
}

std::uint64_t find_element_box_pairs(std::span<const LeafPair> leaf_pairs, const MovingView& a,
                                     const MovingView& b, const PartOfStep& part, bool same_object,
                                     ElementPairBatches& batches) {
  return HWY_DYNAMIC_DISPATCH(ElementBoxPairs)(leaf_pairs.data(), leaf_pairs.size(), a, b, part, same_object,
                                               batches);
}

}  // namespace supple
#endif
