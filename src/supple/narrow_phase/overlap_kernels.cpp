#include "narrow_phase/overlap_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "narrow_phase/overlap_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "octree/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

using LanesTag = hn::CappedTag<float, node_width>;

/// Bit j: the box overlaps lane j. Closed boxes, exact comparisons.
HWY_INLINE std::uint32_t overlap_mask(const AabbLanes& lanes, const Aabb& box) {
  const LanesTag tag;
  std::uint32_t bits = 0;
  for (std::size_t j = 0; j < node_width; j += hn::Lanes(tag)) {
    const auto x = hn::And(hn::Le(hn::Load(tag, lanes.min_x + j), hn::Set(tag, box.max.x)),
                           hn::Ge(hn::Load(tag, lanes.max_x + j), hn::Set(tag, box.min.x)));
    const auto y = hn::And(hn::Le(hn::Load(tag, lanes.min_y + j), hn::Set(tag, box.max.y)),
                           hn::Ge(hn::Load(tag, lanes.max_y + j), hn::Set(tag, box.min.y)));
    const auto z = hn::And(hn::Le(hn::Load(tag, lanes.min_z + j), hn::Set(tag, box.max.z)),
                           hn::Ge(hn::Load(tag, lanes.max_z + j), hn::Set(tag, box.min.z)));
    std::uint8_t part[8] = {};
    hn::StoreMaskBits(tag, hn::And(x, hn::And(y, z)), part);
    bits |= std::uint32_t{part[0]} << j;
  }
  return bits;
}

HWY_INLINE Aabb lane_box(const AabbLanes& lanes, int i) {
  return {{lanes.min_x[i], lanes.min_y[i], lanes.min_z[i]}, {lanes.max_x[i], lanes.max_y[i], lanes.max_z[i]}};
}

HWY_INLINE void place(AabbLanes& lanes, const RelativePlacement& placement) {
  for (int j = 0; j < node_width; ++j) {
    lanes.min_x[j] += placement.offset.x - placement.slop;
    lanes.min_y[j] += placement.offset.y - placement.slop;
    lanes.min_z[j] += placement.offset.z - placement.slop;
    lanes.max_x[j] += placement.offset.x + placement.slop;
    lanes.max_y[j] += placement.offset.y + placement.slop;
    lanes.max_z[j] += placement.offset.z + placement.slop;
  }
}

void BoxOverlapMasks(const NodePair* pairs, std::size_t count, const AabbLanes* a, const AabbLanes* b,
                     const RelativePlacement& placement, std::uint64_t* masks) {
  const bool in_place = placement.is_identity();
  for (std::size_t k = 0; k < count; ++k) {
    const AabbLanes& lanes_a = a[pairs[k].a];
    const AabbLanes* lanes_b = &b[pairs[k].b];
    AabbLanes placed;
    if (!in_place) {
      placed = *lanes_b;
      place(placed, placement);
      lanes_b = &placed;
    }
    std::uint64_t mask = 0;
    for (std::uint32_t rest = pairs[k].lanes_a; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      mask |= std::uint64_t{overlap_mask(*lanes_b, lane_box(lanes_a, i))} << (8 * i);
    }
    masks[k] = mask;
  }
}

/// The boxes of eight triangles from `begin` on, and which of them there are and are not inert.
template <class Box, class Scalar>
HWY_INLINE std::uint32_t load_triangle_boxes(AabbLanes& lanes, const Scalar* vertices,
                                             const TriangleArrays& arrays, std::uint32_t begin,
                                             std::uint32_t end) {
  const int count = static_cast<int>(std::min<std::uint32_t>(end - begin, node_width));
  std::uint32_t valid = 0;
  for (int j = 0; j < count; ++j) {
    const std::uint32_t t = begin + static_cast<std::uint32_t>(j);
    set_lane_to_triangles<Box>(lanes, j, vertices, arrays, t, t + 1);
    valid |= (arrays.inert == nullptr || arrays.inert[t] == 0 ? 1u : 0u) << j;
  }
  invert_lanes_from(lanes, count);
  return valid;
}

HWY_INLINE std::uint32_t load_boxes(AabbLanes& lanes, const TriangleArrays& arrays, std::uint32_t begin,
                                    std::uint32_t end) {
  return arrays.doubles != nullptr ? load_triangle_boxes<DoubleBox>(lanes, arrays.doubles, arrays, begin, end)
                                   : load_triangle_boxes<FloatBox>(lanes, arrays.floats, arrays, begin, end);
}

HWY_INLINE bool share_vertex(const Triangle& p, const Triangle& q) {
  bool shared = false;
  for (const std::uint32_t vertex : p) {
    for (const std::uint32_t other : q) shared |= vertex == other;
  }
  return shared;
}

/// What `find_triangle_box_pairs` does, for one call.
class LeafTests {
 public:
  HWY_INLINE LeafTests(const TriangleArrays& a, const TriangleArrays& b, const RelativePlacement& placement,
                       bool same_object, std::vector<TrianglePair>& pairs)
      : a_(a), b_(b), placement_(placement), same_object_(same_object), pairs_(pairs) {}

  HWY_INLINE void test(const LeafPair& leaves) {
    for (std::uint32_t first_a = leaves.begin_a; first_a < leaves.end_a; first_a += node_width) {
      // Leaf pairs come in runs that share the first leaf.
      if (first_a != loaded_a_) valid_a_ = load_boxes(boxes_a_, a_, first_a, leaves.end_a);
      loaded_a_ = first_a;
      for (std::uint32_t first_b = leaves.begin_b; first_b < leaves.end_b; first_b += node_width) {
        const std::uint32_t valid_b = load_boxes(boxes_b_, b_, first_b, leaves.end_b);
        if (!placement_.is_identity()) place(boxes_b_, placement_);
        test_eight(leaves, first_a, first_b, valid_b);
      }
    }
  }
  std::uint64_t box_tests() const { return tests_ * node_width; }

 private:
  HWY_INLINE void test_eight(const LeafPair& leaves, std::uint32_t first_a, std::uint32_t first_b,
                             std::uint32_t valid_b) {
    for (std::uint32_t rest = valid_a_; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const std::uint32_t triangle_a = first_a + static_cast<std::uint32_t>(i);
      ++tests_;
      std::uint32_t hits = overlap_mask(boxes_b_, lane_box(boxes_a_, i)) & valid_b;
      for (; hits != 0; hits &= hits - 1) {
        const std::uint32_t triangle_b = first_b + static_cast<std::uint32_t>(std::countr_zero(hits));
        if (same_object_) {
          // Within one leaf each pair would come twice.
          if (leaves.begin_a == leaves.begin_b && triangle_b <= triangle_a) continue;
          if (share_vertex(a_.triangles[triangle_a], b_.triangles[triangle_b])) continue;
        }
        pairs_.push_back({triangle_a, triangle_b});
      }
    }
  }

  const TriangleArrays& a_;
  const TriangleArrays& b_;
  const RelativePlacement& placement_;
  bool same_object_;
  std::vector<TrianglePair>& pairs_;
  AabbLanes boxes_a_, boxes_b_;
  std::uint32_t loaded_a_ = ~std::uint32_t{0};
  std::uint32_t valid_a_ = 0;
  std::uint64_t tests_ = 0;
};

std::uint64_t TriangleBoxPairs(const LeafPair* leaf_pairs, std::size_t count, const TriangleArrays& a,
                               const TriangleArrays& b, const RelativePlacement& placement, bool same_object,
                               std::vector<TrianglePair>& pairs) {
  LeafTests tests(a, b, placement, same_object, pairs);
  for (std::size_t k = 0; k < count; ++k) tests.test(leaf_pairs[k]);
  return tests.box_tests();
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(BoxOverlapMasks);
HWY_EXPORT(TriangleBoxPairs);

void overlap_masks(std::span<const NodePair> pairs, const AabbLanes* a, const AabbLanes* b,
                   const RelativePlacement& placement, std::uint64_t* masks) {
  HWY_DYNAMIC_DISPATCH(BoxOverlapMasks)(pairs.data(), pairs.size(), a, b, placement, masks);
}

std::uint64_t find_triangle_box_pairs(std::span<const LeafPair> leaf_pairs, const TriangleArrays& a,
                                      const TriangleArrays& b, const RelativePlacement& placement,
                                      bool same_object, std::vector<TrianglePair>& pairs) {
  return HWY_DYNAMIC_DISPATCH(TriangleBoxPairs)(leaf_pairs.data(), leaf_pairs.size(), a, b, placement,
                                                same_object, pairs);
}

namespace {

/// Bit j: the ball may touch lane j. In double, where neither the differences nor the squares of floats
/// overflow.
std::uint64_t overlap_mask(const SphereLanes& a, int i, const SphereLanes& b,
                           const RelativePlacement& placement) {
  std::uint64_t bits = 0;
  for (int j = 0; j < node_width; ++j) {
    const double dx = double{b.x[j]} + placement.offset.x - a.x[i];
    const double dy = double{b.y[j]} + placement.offset.y - a.y[i];
    const double dz = double{b.z[j]} + placement.offset.z - a.z[i];
    const double reach = double{a.radius[i]} + b.radius[j] + placement.slop;
    // The roundings are well inside the factor; written so that NaN overlaps.
    const bool apart = dx * dx + dy * dy + dz * dz > reach * reach * (1 + 0x1p-49);
    const bool empty = a.radius[i] < 0 || b.radius[j] < 0;
    bits |= std::uint64_t{!(apart || empty)} << j;
  }
  return bits;
}

}  // namespace

void overlap_masks(std::span<const NodePair> pairs, const SphereLanes* a, const SphereLanes* b,
                   const RelativePlacement& placement, std::uint64_t* masks) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    masks[k] = 0;
    for (std::uint32_t rest = pairs[k].lanes_a; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      masks[k] |= overlap_mask(a[pairs[k].a], i, b[pairs[k].b], placement) << (8 * i);
    }
  }
}

}  // namespace supple
#endif
