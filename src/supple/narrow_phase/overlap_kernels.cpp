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

/// The boxes of up to eight triangles from `begin` on. Further lanes get that of the last one: less than
/// guessing how many there are.
template <class Box, class Scalar>
HWY_INLINE void load_triangle_boxes(LeafBoxes& leaf, const Scalar* vertices, const TriangleArrays& arrays,
                                    std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t first = 0; first < node_width; first += 4) {
    Box boxes[4];
    for (std::uint32_t i = 0; i < 4; ++i) {
      extend_by_triangle(boxes[i], vertices, arrays.triangles[std::min(begin + first + i, end - 1)]);
    }
    set_four_lanes(leaf.lanes, static_cast<int>(first), boxes);
  }
  const std::uint32_t count = std::min<std::uint32_t>(end - begin, node_width);
  leaf.lane_mask = (1u << count) - 1;
  for (std::uint32_t i = 0; arrays.inert != nullptr && i < count; ++i) {
    if (arrays.inert[begin + i] != 0) leaf.lane_mask &= ~(1u << i);
  }
}

HWY_INLINE void load_boxes(LeafBoxes& leaf, const TriangleArrays& arrays, std::uint32_t begin,
                           std::uint32_t end) {
  if (arrays.doubles != nullptr) {
    load_triangle_boxes<DoubleBox>(leaf, arrays.doubles, arrays, begin, end);
  } else {
    load_triangle_boxes<FloatBox>(leaf, arrays.floats, arrays, begin, end);
  }
}

HWY_INLINE bool share_vertex(const Triangle& p, const Triangle& q) {
  bool shared = false;
  for (const std::uint32_t vertex : p) {
    for (const std::uint32_t other : q) shared |= vertex == other;
  }
  return shared;
}

/// Bit i to the bits of byte i.
HWY_INLINE std::uint64_t spread_to_bytes(std::uint32_t bits) {
  const std::uint64_t copies = bits * 0x0101010101010101u;
  const std::uint64_t ones = copies & 0x8040201008040201u;  // one bit of each byte
  return ((ones + 0x7f7f7f7f7f7f7f7fu) >> 7 & 0x0101010101010101u) * 0xffu;
}

/// What `find_triangle_box_pairs` does, for one call.
class LeafTests {
 public:
  HWY_INLINE LeafTests(const TriangleArrays& a, const TriangleArrays& b, const RelativePlacement& placement,
                       bool same_object, LeafBoxCache& cache, TrianglePairList& pairs)
      : a_(a), b_(b), placement_(placement), same_object_(same_object), cache_(cache), pairs_(pairs) {}

  HWY_INLINE void test(const LeafPair& leaves) {
    for (std::uint32_t first_a = leaves.begin_a; first_a < leaves.end_a; first_a += node_width) {
      const LeafBoxes& boxes_a = boxes_of_a(first_a, leaves.end_a);
      for (std::uint32_t first_b = leaves.begin_b; first_b < leaves.end_b; first_b += node_width) {
        test_eight(leaves, boxes_a, boxes_of_b(first_b, leaves.end_b));
      }
    }
  }
  std::uint64_t box_tests() const { return tests_ * node_width * node_width; }

 private:
  /// Leaves that follow each other in octree order fall into different places.
  static HWY_INLINE LeafBoxes& place_in(std::array<LeafBoxes, LeafBoxCache::size>& entries,
                                        std::uint32_t first) {
    static_assert(LeafBoxCache::size == 32);
    return entries[first * 0x9e3779b1u >> 27];
  }

  HWY_INLINE const LeafBoxes& boxes_of_a(std::uint32_t first, std::uint32_t end) {
    LeafBoxes& entry = place_in(cache_.a, first);
    if (entry.first != first) load_boxes(entry, a_, first, end);
    entry.first = first;
    return entry;
  }
  HWY_INLINE const LeafBoxes& boxes_of_b(std::uint32_t first, std::uint32_t end) {
    LeafBoxes& entry = place_in(cache_.b, first);
    if (entry.first == first) return entry;
    load_boxes(entry, b_, first, end);
    entry.first = first;
    if (!placement_.is_identity()) place(entry.lanes, placement_);
    return entry;
  }

  /// All eight against all eight, as there is no telling which.
  HWY_INLINE void test_eight(const LeafPair& leaves, const LeafBoxes& boxes_a, const LeafBoxes& boxes_b) {
    std::uint64_t hits = 0;
    for (int i = 0; i < node_width; ++i) {
      hits |= std::uint64_t{overlap_mask(boxes_b.lanes, lane_box(boxes_a.lanes, i)) & boxes_b.lane_mask}
              << (8 * i);
    }
    hits &= spread_to_bytes(boxes_a.lane_mask);
    ++tests_;
    TrianglePair* const room = pairs_.room_for(64);
    std::size_t count = 0;
    for (; hits != 0; hits &= hits - 1) {
      const auto place = static_cast<std::uint32_t>(std::countr_zero(hits));
      const TrianglePair pair{boxes_a.first + (place >> 3), boxes_b.first + (place & 7)};
      room[count] = pair;
      count += same_object_ && is_left_out(leaves, pair) ? 0 : 1;
    }
    pairs_.added(count);
  }

  HWY_INLINE bool is_left_out(const LeafPair& leaves, const TrianglePair& pair) const {
    // Within one leaf each pair would come twice.
    if (leaves.begin_a == leaves.begin_b && pair.b <= pair.a) return true;
    return share_vertex(a_.triangles[pair.a], b_.triangles[pair.b]);
  }

  const TriangleArrays& a_;
  const TriangleArrays& b_;
  const RelativePlacement& placement_;
  bool same_object_;
  LeafBoxCache& cache_;
  TrianglePairList& pairs_;
  std::uint64_t tests_ = 0;
};

std::uint64_t TriangleBoxPairs(const LeafPair* leaf_pairs, std::size_t count, const TriangleArrays& a,
                               const TriangleArrays& b, const RelativePlacement& placement, bool same_object,
                               LeafBoxCache& cache, TrianglePairList& pairs) {
  LeafTests tests(a, b, placement, same_object, cache, pairs);
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
                                      bool same_object, LeafBoxCache& cache, TrianglePairList& pairs) {
  return HWY_DYNAMIC_DISPATCH(TriangleBoxPairs)(leaf_pairs.data(), leaf_pairs.size(), a, b, placement,
                                                same_object, cache, pairs);
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
