#include "narrow_phase/overlap_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "narrow_phase/overlap_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <type_traits>
#include <utility>

#include "core/packed_lanes-inl.hpp"
#include "mesh/share_vertex.hpp"
#include "octree/volumes/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

/// The boxes from `first` on, a vector of them, that overlap `box`. Closed boxes, exact comparisons.
template <class Tag, class Boxes>
HWY_INLINE hn::Mask<Tag> overlapping(Tag tag, const Boxes& boxes, std::size_t first, const Aabb& box) {
  const auto x = hn::And(hn::Le(hn::Load(tag, boxes.min_x + first), hn::Set(tag, box.max.x)),
                         hn::Ge(hn::Load(tag, boxes.max_x + first), hn::Set(tag, box.min.x)));
  const auto y = hn::And(hn::Le(hn::Load(tag, boxes.min_y + first), hn::Set(tag, box.max.y)),
                         hn::Ge(hn::Load(tag, boxes.max_y + first), hn::Set(tag, box.min.y)));
  const auto z = hn::And(hn::Le(hn::Load(tag, boxes.min_z + first), hn::Set(tag, box.max.z)),
                         hn::Ge(hn::Load(tag, boxes.max_z + first), hn::Set(tag, box.min.z)));
  return hn::And(x, hn::And(y, z));
}

template <class Tag, class Boxes>
HWY_INLINE std::uint64_t overlapping_bits(Tag tag, const Boxes& boxes, std::size_t count, const Aabb& box) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag))
    bits |= mask_bits(tag, overlapping(tag, boxes, i, box)) << i;
  return bits;
}

/// Moves and grows the boxes of six arrays.
template <class Arrays>
HWY_INLINE void place(Arrays& boxes, const RelativePlacement& placement) {
  for (std::size_t i = 0; i < std::size(boxes.min_x); ++i) {
    boxes.min_x[i] += placement.offset.x - placement.slop;
    boxes.min_y[i] += placement.offset.y - placement.slop;
    boxes.min_z[i] += placement.offset.z - placement.slop;
    boxes.max_x[i] += placement.offset.x + placement.slop;
    boxes.max_y[i] += placement.offset.y + placement.slop;
    boxes.max_z[i] += placement.offset.z + placement.slop;
  }
}

void BoxOverlapMasks(const NodePair* pairs, std::size_t count, const ChildBoxes* a, const ChildBoxes* b,
                     const RelativePlacement& placement, std::uint64_t* masks) {
  const hn::CappedTag<float, node_width> tag;
  const bool in_place = placement.is_identity();
  for (std::size_t k = 0; k < count; ++k) {
    const ChildBoxes& boxes_a = a[pairs[k].a];
    const ChildBoxes* boxes_b = &b[pairs[k].b];
    ChildBoxes placed;
    if (!in_place) {
      placed = *boxes_b;
      place(placed, placement);
      boxes_b = &placed;
    }
    std::uint64_t mask = 0;
    for (std::uint32_t rest = pairs[k].children_a; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      mask |= overlapping_bits(tag, *boxes_b, node_width, child_box(boxes_a, i)) << (node_width * i);
    }
    masks[k] = mask;
  }
}

using BoxTag = hn::CappedTag<float, 16>;
using NumberTag = hn::Rebind<std::uint32_t, BoxTag>;
using BoxVec = hn::Vec<BoxTag>;
using NumberVec = hn::Vec<NumberTag>;
using BoxMask = hn::Mask<BoxTag>;

/// Loads the boxes of the triangles [begin, end), at most a block, four at a time. Repeats the last triangle
/// to fill up the last four.
template <class Box, class Scalar>
HWY_INLINE void load_triangle_boxes(LeafBoxes& leaf, VertexArray<Scalar> positions, const Triangle* triangles,
                                    std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t first = begin; first < end; first += 4) {
    Box boxes[4];
    for (std::uint32_t i = 0; i < 4; ++i) {
      extend_by_triangle(boxes[i], positions, triangles[std::min(first + i, end - 1)]);
    }
    set_four_boxes(leaf, first - begin, boxes);
  }
}

#if HWY_TARGET != HWY_SCALAR

/// The vertices of a leaf in tables from which the boxes of its triangles are looked up in registers. This is
/// far less work than to read three vertices of each triangle from memory. Floats do not use `high`, which
/// would equal `low`.
struct LeafVertexTables {
  /// The greatest number of vectors in a table. Looking up vertices in more takes longer than reading them.
  static constexpr std::size_t most_vectors = 4, lanes = hn::MaxLanes(BoxTag());
  static constexpr std::size_t capacity = std::min<std::size_t>(64, most_vectors* lanes);

  std::size_t count;
  HWY_ALIGN float low[3][capacity];
  HWY_ALIGN float high[3][capacity];
};

/// `count` is a multiple of four.
HWY_INLINE void load_vertices(LeafVertexTables& tables, VertexArray<float> positions,
                              const std::uint32_t* vertices, std::size_t count) {
  for (std::size_t i = 0; i < count; i += leaf_vertices_step) {
    store_transposed(load_vertex(positions[vertices[i]]), load_vertex(positions[vertices[i + 1]]),
                     load_vertex(positions[vertices[i + 2]]), load_vertex(positions[vertices[i + 3]]),
                     tables.low[0] + i, tables.low[1] + i, tables.low[2] + i);
  }
  tables.count = count;
}

HWY_INLINE void load_vertices(LeafVertexTables& tables, VertexArray<double> positions,
                              const std::uint32_t* vertices, std::size_t count) {
  for (std::size_t i = 0; i < count; i += leaf_vertices_step) {
    DoubleBox boxes[leaf_vertices_step];
    for (std::size_t k = 0; k < leaf_vertices_step; ++k) boxes[k].extend(positions[vertices[i + k]]);
    store_transposed(boxes[0].lower(), boxes[1].lower(), boxes[2].lower(), boxes[3].lower(),
                     tables.low[0] + i, tables.low[1] + i, tables.low[2] + i);
    store_transposed(boxes[0].upper(), boxes[1].upper(), boxes[2].upper(), boxes[3].upper(),
                     tables.high[0] + i, tables.high[1] + i, tables.high[2] + i);
  }
  tables.count = count;
}

/// One corner of each triangle in a vector of triangles.
class Corners {
 public:
  HWY_INLINE explicit Corners(const std::uint8_t* places)
      : place_(hn::PromoteTo(NumberTag(), hn::LoadU(hn::Rebind<std::uint8_t, NumberTag>(), places))),
        in_vector_(hn::IndicesFromVec(BoxTag(),
                                      hn::And(place_, hn::Set(NumberTag(), LeafVertexTables::lanes - 1)))) {}

  HWY_INLINE BoxVec of(const float* table, std::size_t count) const {
    const BoxTag tag;
    auto value = hn::TableLookupLanes(hn::Load(tag, table), in_vector_);
    for (std::size_t begin = LeafVertexTables::lanes; begin < count; begin += LeafVertexTables::lanes) {
      const auto last_before = hn::Set(NumberTag(), static_cast<std::uint32_t>(begin - 1));
      value = hn::IfThenElse(hn::RebindMask(tag, hn::Gt(place_, last_before)),
                             hn::TableLookupLanes(hn::Load(tag, table + begin), in_vector_), value);
    }
    return value;
  }

 private:
  NumberVec place_;
  decltype(hn::IndicesFromVec(BoxTag(), NumberVec())) in_vector_;
};

/// Looks up the boxes of a vector of triangles, whose corners start at `corners`, and stores them from `to`
/// on.
template <class Scalar>
HWY_INLINE void look_up(const LeafVertexTables& tables, const std::uint8_t* corners, std::size_t stride,
                        LeafBoxes& boxes, std::size_t to) {
  const BoxTag tag;
  const Corners p(corners), q(corners + stride), r(corners + 2 * stride);
  float* const lows[3] = {boxes.min_x + to, boxes.min_y + to, boxes.min_z + to};
  float* const highs[3] = {boxes.max_x + to, boxes.max_y + to, boxes.max_z + to};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* const low = tables.low[axis];
    const auto lp = p.of(low, tables.count), lq = q.of(low, tables.count), lr = r.of(low, tables.count);
    hn::Store(hn::Min(hn::Min(lp, lq), lr), tag, lows[axis]);
    if constexpr (std::is_same_v<Scalar, float>) {
      hn::Store(hn::Max(hn::Max(lp, lq), lr), tag, highs[axis]);
    } else {
      const float* const high = tables.high[axis];
      const auto hp = p.of(high, tables.count), hq = q.of(high, tables.count), hr = r.of(high, tables.count);
      hn::Store(hn::Max(hn::Max(hp, hq), hr), tag, highs[axis]);
    }
  }
}

#endif

/// Not inlined: Highway's portable vectors are loops over lanes, and the time to compile a function grows
/// with the square of its number of loops. A call costs little compared to a leaf.
template <class Box, class Scalar>
HWY_NOINLINE void load_leaf_boxes(LeafBoxes& leaf, VertexArray<Scalar> positions, const LeafArrays& object,
                                  [[maybe_unused]] std::uint32_t leaf_number, std::uint32_t begin,
                                  std::uint32_t end) {
#if HWY_TARGET != HWY_SCALAR
  const LeafVertexArrays leaves = object.vertices;
  const std::size_t first = leaves.first[leaf_number], count = leaves.first[leaf_number + 1] - first;
  if (count <= LeafVertexTables::capacity) {
    LeafVertexTables tables;
    load_vertices(tables, positions, leaves.vertices + first, count);
    for (std::size_t t = begin; t < end; t += LeafVertexTables::lanes) {
      look_up<Scalar>(tables, leaves.corners + t, leaves.stride, leaf, t - begin);
    }
    return;
  }
#endif
  load_triangle_boxes<Box>(leaf, positions, object.triangles.triangles, begin, end);
}

/// Loads the boxes of the triangles [begin, end) of a leaf, at most a block.
void LoadLeafBoxes(const LeafArrays& object, std::uint32_t leaf_number, std::uint32_t begin,
                   std::uint32_t end, LeafBoxes& leaf) {
  const TriangleArrays& arrays = object.triangles;
  if (arrays.doubles.data != nullptr) {
    load_leaf_boxes<DoubleBox>(leaf, arrays.doubles, object, leaf_number, begin, end);
  } else {
    load_leaf_boxes<FloatBox>(leaf, arrays.floats, object, leaf_number, begin, end);
  }
  leaf.size = end - begin;
  leaf.triangles = ~std::uint64_t{0} >> (leaf_block - leaf.size);
  for (std::uint32_t t = begin; arrays.inert != nullptr && t < end; ++t) {
    if (arrays.inert[t] != 0) leaf.triangles &= ~(std::uint64_t{1} << (t - begin));
  }
}

std::uint64_t OverlappingChildren(const Aabb& box, const ChildBoxes& boxes) {
  return overlapping_bits(hn::CappedTag<float, node_width>(), boxes, node_width, box);
}
HWY_INLINE std::uint64_t OverlappingTriangles(const Aabb& box, const LeafBoxes& leaf) {
  return overlapping_bits(BoxTag(), leaf, leaf.size, box) & leaf.triangles;
}

HWY_INLINE BoxMask mask_of(std::uint64_t bits) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)};
  return hn::LoadMaskBits(BoxTag(), bytes);
}

#if HWY_TARGET <= HWY_AVX2

/// Writes a pair of each chosen triangle with `other`, and returns their number. Always writes a whole vector
/// of pairs, so that no branch depends on the choice.
template <bool chosen_is_b>
HWY_INLINE std::size_t store_pairs(NumberVec triangles, BoxMask chosen, std::uint32_t other,
                                   TrianglePair* pairs) {
  static_assert(std::endian::native == std::endian::little && sizeof(TrianglePair) == 8);
  const NumberTag numbers;
  const hn::Half<NumberTag> half;
  const hn::Repartition<std::uint64_t, NumberTag> whole_pairs;
  const auto others = hn::Set(whole_pairs, chosen_is_b ? std::uint64_t{other} : std::uint64_t{other} << 32);
  const auto paired = [&](hn::Vec<hn::Half<NumberTag>> v) HWY_ATTR {
    const auto wide = hn::PromoteTo(whole_pairs, v);
    if constexpr (chosen_is_b) return hn::Or(hn::ShiftLeft<32>(wide), others);
    return hn::Or(wide, others);
  };
  const auto compressed = packed_lanes(numbers, triangles, hn::RebindMask(numbers, chosen));
  auto* const place = reinterpret_cast<std::uint64_t*>(pairs);
  hn::StoreU(paired(hn::LowerHalf(half, compressed)), whole_pairs, place);
  hn::StoreU(paired(hn::UpperHalf(half, compressed)), whole_pairs, place + hn::Lanes(whole_pairs));
  return hn::CountTrue(BoxTag(), chosen);
}

#else

template <bool chosen_is_b>
HWY_INLINE std::size_t store_pairs(NumberVec triangles, BoxMask chosen, std::uint32_t other,
                                   TrianglePair* pairs) {
  const std::uint32_t first = hn::GetLane(triangles);
  std::size_t count = 0;
  for (std::uint64_t bits = mask_bits(BoxTag(), chosen); bits != 0; bits &= bits - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(bits));
    const std::uint32_t triangle = first + place;
    pairs[count++] = chosen_is_b ? TrianglePair{other, triangle} : TrianglePair{triangle, other};
  }
  return count;
}

#endif

/// One call of `find_triangle_box_pairs`.
class LeafTests {
 public:
  HWY_INLINE LeafTests(const LeafArrays& a, const LeafArrays& b, const RelativePlacement& placement,
                       bool same_object, LeafBoxCache& cache, TrianglePairList& pairs)
      : a_(a), b_(b), placement_(placement), same_object_(same_object), cache_(cache), pairs_(pairs) {}

  HWY_INLINE void test(const LeafPair& leaves) {
    const bool same_leaf = same_object_ && leaves.begin_a == leaves.begin_b;
    const Aabb box_a = leaf_box(a_, leaves.leaf_a), box_b = placed(leaf_box(b_, leaves.leaf_b), placement_);
    for (std::uint32_t first_a = leaves.begin_a; first_a < leaves.end_a; first_a += leaf_block) {
      const LeafBoxes& boxes_a = boxes_of(a_, cache_.a, leaves.leaf_a, first_a, leaves.end_a);
      const std::uint64_t some_a = near(boxes_a, box_b);
      if (some_a == 0) continue;
      for (std::uint32_t first_b = same_leaf ? first_a : leaves.begin_b; first_b < leaves.end_b;
           first_b += leaf_block) {
        const LeafBoxes& boxes_b = boxes_of(b_, cache_.b, leaves.leaf_b, first_b, leaves.end_b);
        const std::uint64_t some_b = near(boxes_b, box_a);
        if (same_leaf && first_a == first_b) {
          match<true, true>(first_a, boxes_a, some_a, first_b, boxes_b, some_b);
        } else if (std::popcount(some_a) <= std::popcount(some_b)) {
          match<true, false>(first_a, boxes_a, some_a, first_b, boxes_b, some_b);
        } else {
          match<false, false>(first_b, boxes_b, some_b, first_a, boxes_a, some_a);
        }
      }
    }
  }
  std::uint64_t box_tests() const { return tests_; }

 private:
  static HWY_INLINE Aabb leaf_box(const LeafArrays& object, std::uint32_t leaf_number) {
    return child_box(object.boxes[leaf_number / node_width], static_cast<int>(leaf_number % node_width));
  }

  /// Maps consecutive blocks in octree order to different places.
  static HWY_INLINE std::size_t place_of(std::uint32_t first) {
    static_assert(LeafBoxCache::size == 32);
    return first * 0x9e3779b1u >> 27;
  }
  HWY_INLINE const LeafBoxes& boxes_of(const LeafArrays& object, LeafBoxCache::Side& side,
                                       std::uint32_t leaf_number, std::uint32_t first,
                                       std::uint32_t leaf_end) {
    const std::size_t place = place_of(first);
    LeafBoxes& entry = side.boxes[place];
    if (std::exchange(side.first_triangles[place], first) != first) {
      LoadLeafBoxes(object, leaf_number, first, std::min(first + leaf_block, leaf_end), entry);
      const bool is_placed = &side == &cache_.b && !placement_.is_identity();
      if (is_placed) supple::HWY_NAMESPACE::place(entry, placement_);
    }
    return entry;
  }

  HWY_INLINE std::uint64_t near(const LeafBoxes& boxes, const Aabb& leaf) {
    tests_ += boxes.size;
    return OverlappingTriangles(leaf, boxes);
  }

  /// Tests each of `ones` against vectors of `others`; in a block against itself, only with later triangles.
  template <bool others_are_b, bool each_with_later>
  HWY_INLINE void match(std::uint32_t first_one, const LeafBoxes& ones, std::uint64_t some_ones,
                        std::uint32_t first_other, const LeafBoxes& others, std::uint64_t some_others) {
    constexpr std::uint32_t lanes = hn::MaxLanes(BoxTag());
    constexpr std::uint64_t all_lanes = (std::uint64_t{1} << lanes) - 1;
    const auto count_ones = static_cast<std::size_t>(std::popcount(some_ones));
    tests_ += count_ones * static_cast<std::uint64_t>(std::popcount(some_others));
    TrianglePair* const room = pairs_.room_for(count_ones * leaf_block + lanes);
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < others.size; i += lanes) {
      const std::uint64_t some = some_others >> i & all_lanes;
      if (some == 0) continue;
      const BoxMask wanted = mask_of(some);
      const NumberVec triangles = hn::Iota(NumberTag(), first_other + i);
      for (std::uint64_t rest = some_ones; rest != 0; rest &= rest - 1) {
        const auto one = static_cast<std::uint32_t>(std::countr_zero(rest));
        BoxMask hits = hn::And(overlapping(BoxTag(), others, i, ones.box(one)), wanted);
        if constexpr (each_with_later) {
          const std::uint32_t not_later = one < i ? 0 : std::min(one - i + 1, lanes);
          hits = hn::And(hits, mask_of(all_lanes << not_later & all_lanes));
        }
        count += store_pairs<others_are_b>(triangles, hits, first_one + one, room + count);
      }
    }
    pairs_.added(same_object_ ? without_neighbours(room, count) : count);
  }

  /// Removes the pairs that share a vertex, and returns the number of those that stay. Adds instead of
  /// branching, because these branches are hard to predict.
  HWY_INLINE std::size_t without_neighbours(TrianglePair* pairs, std::size_t count) const {
    const Triangle* const triangles = a_.triangles.triangles;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const TrianglePair pair = pairs[i];
      pairs[kept] = pair;
      kept += share_vertex(triangles[pair.a], triangles[pair.b]) ? 0 : 1;
    }
    return kept;
  }

  const LeafArrays& a_;
  const LeafArrays& b_;
  const RelativePlacement& placement_;
  bool same_object_;
  LeafBoxCache& cache_;
  TrianglePairList& pairs_;
  std::uint64_t tests_ = 0;
};

std::uint64_t TriangleBoxPairs(const LeafPair* leaf_pairs, std::size_t count, const LeafArrays& a,
                               const LeafArrays& b, const RelativePlacement& placement, bool same_object,
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
HWY_EXPORT(LoadLeafBoxes);
HWY_EXPORT(OverlappingChildren);
HWY_EXPORT(OverlappingTriangles);
HWY_EXPORT(TriangleBoxPairs);

void overlap_masks(std::span<const NodePair> pairs, const ChildBoxes* a, const ChildBoxes* b,
                   const RelativePlacement& placement, std::uint64_t* masks) {
  HWY_DYNAMIC_DISPATCH(BoxOverlapMasks)(pairs.data(), pairs.size(), a, b, placement, masks);
}

void load_leaf_boxes(const LeafArrays& object, std::uint32_t leaf, std::uint32_t begin, std::uint32_t end,
                     LeafBoxes& boxes) {
  HWY_DYNAMIC_DISPATCH(LoadLeafBoxes)(object, leaf, begin, end, boxes);
}

std::uint32_t overlapping_children(const Aabb& box, const ChildBoxes& boxes) {
  return static_cast<std::uint32_t>(HWY_DYNAMIC_DISPATCH(OverlappingChildren)(box, boxes));
}
std::uint64_t overlapping_triangles(const Aabb& box, const LeafBoxes& boxes) {
  return HWY_DYNAMIC_DISPATCH(OverlappingTriangles)(box, boxes);
}

std::uint64_t find_triangle_box_pairs(std::span<const LeafPair> leaf_pairs, const LeafArrays& a,
                                      const LeafArrays& b, const RelativePlacement& placement,
                                      bool same_object, LeafBoxCache& cache, TrianglePairList& pairs) {
  return HWY_DYNAMIC_DISPATCH(TriangleBoxPairs)(leaf_pairs.data(), leaf_pairs.size(), a, b, placement,
                                                same_object, cache, pairs);
}

}  // namespace supple
#endif
