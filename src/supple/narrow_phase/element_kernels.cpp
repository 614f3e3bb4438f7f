#include "narrow_phase/element_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "narrow_phase/element_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "core/packed_lanes-inl.hpp"
#include "narrow_phase/moving_box_tests-inl.hpp"
#include "octree/volumes/triangle_boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void MovingOverlapMasks(const NodePair* pairs, std::size_t count, const MovingView& a, const MovingView& b,
                        const PartOfStep& part, std::uint64_t* masks) {
  const hn::CappedTag<float, node_width> tag;
  // Here the boxes of a are placed, because there is one of them for each vector of b.
  PartOfStep part_a = part;
  part_a.offset = {-part.offset.x, -part.offset.y, -part.offset.z};
  const bool at_rest = are_at_rest(a, b, part);
  for (std::size_t k = 0; k < count; ++k) {
    const MovingBoxArrays boxes_a = child_boxes(a, pairs[k].a, at_rest),
                          boxes_b = child_boxes(b, pairs[k].b, at_rest);
    std::uint64_t mask = 0;
    for (std::uint32_t rest = pairs[k].children_a; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const MovingBox box = moving_box(boxes_a, i, part_a);
      for (std::size_t j = 0; j < node_width; j += hn::Lanes(tag)) {
        mask |= meeting_bits(tag, box, boxes_b, j, part.latest) << (8 * i + j);
      }
    }
    masks[k] = mask;
  }
}

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

/// Sets the boxes of the elements of a range at one end of the step, four at a time.
template <class Ids>
HWY_INLINE void set_boxes(const VertexCorners& corners, const Ids& ids, ElementRange range,
                          float (&boxes)[6][leaf_block]) {
  const std::uint32_t last = range.size() - 1;
  for (std::uint32_t i = 0; i < range.size(); i += 4) {
    FloatBox four[4];
    for (std::uint32_t k = 0; k < 4; ++k)
      four[k] = element_box(corners, ids, range.begin + std::min(i + k, last));
    store_four_boxes(four, boxes, i);
  }
}

/// The boxes of a range of at most `leaf_block` elements. Those of object b are placed.
template <class Ids>
HWY_INLINE void set_block(const MovingView& view, const Ids& ids, ElementRange range, const PartOfStep& part,
                          bool with_vertices, bool at_rest, MovingBoxBlock& block) {
  for (std::uint32_t i = 0; with_vertices && i < range.size(); ++i) {
    for (int corner = 0; corner < Ids::corner_count; ++corner)
      block.vertices[corner][i] = static_cast<std::uint32_t>(ids.vertex(range.begin + i, corner));
  }
  set_boxes(view.start_corners, ids, range, block.start);
  if (!at_rest) set_boxes(view.end_corners, ids, range, block.end);
  if (!part.keeps_boxes()) {
    const hn::CappedTag<float, 16> tag;
    for (int side = 0; side < 6; ++side) {
      for (std::size_t i = 0; i < range.size(); i += hn::Lanes(tag))
        place_and_shorten(tag, block.start[side] + i, (at_rest ? block.start : block.end)[side] + i, side,
                          part);
    }
  }
  if (view.inert == nullptr) return;
  for (std::uint32_t i = 0; i < range.size(); ++i) {
    bool is_inert = false;
    for (int corner = 0; corner < Ids::corner_count; ++corner)
      is_inert = is_inert || view.inert[ids.vertex(range.begin + i, corner)] != 0;
    for (int side = 0; is_inert && side < 6; ++side) {
      constexpr float inf = std::numeric_limits<float>::infinity();
      block.start[side][i] = block.end[side][i] = side < 3 ? inf : -inf;
    }
  }
}

/// The same for every instruction set, so that the order of pairs is too.
constexpr std::uint32_t group = 16;

/// Bits of a group of boxes of the block, from `first` on, that are not apart from `box`.
HWY_INLINE std::uint64_t meeting_group(const MovingBox& box, const MovingBoxBlock& block, bool at_rest,
                                       std::size_t first) {
  const hn::CappedTag<float, group> tag;
  std::uint64_t bits = 0;
  for (std::size_t j = 0; j < group; j += hn::Lanes(tag))
    bits |= meeting_bits(tag, box, arrays_of(block, at_rest), first + j, 1) << j;
  return bits;
}

/// Bits of the elements of a block that are not apart from `box`. Not inlined, because compilers would take
/// minutes.
HWY_NOINLINE std::uint64_t meeting_elements(const MovingBox& box, const MovingBoxBlock& block, bool at_rest,
                                            std::uint32_t count) {
  std::uint64_t bits = 0;
  for (std::uint32_t first = 0; first < count; first += group)
    bits |= meeting_group(box, block, at_rest, first) << first;
  return bits & ~std::uint64_t{0} >> (leaf_block - count);
}

/// Bits of a group of elements, from `first` on, that share a vertex with element `one`.
template <int corners_of_one, int corners_of_other>
HWY_INLINE std::uint64_t neighbours_in_group(const MovingBoxBlock& ones, std::size_t one,
                                             const MovingBoxBlock& others, std::size_t first) {
  const hn::CappedTag<std::uint32_t, group> tag;
  std::uint64_t bits = 0;
  for (std::size_t j = 0; j < group; j += hn::Lanes(tag)) {
    auto same = hn::FirstN(tag, 0);
    for (int p = 0; p < corners_of_one; ++p) {
      const auto vertex = hn::Set(tag, ones.vertices[p][one]);
      for (int q = 0; q < corners_of_other; ++q)
        same = hn::Or(same, hn::Eq(vertex, hn::LoadU(tag, others.vertices[q] + first + j)));
    }
    bits |= mask_bits(tag, same) << j;
  }
  return bits;
}

/// For each of `ones`, the bits of a group of `others` in `some_others`, from `first` on, that are not apart
/// from it; without those that share a vertex with it if `skips_neighbours`. Returns bits of the ones that
/// have some.
template <int corners_of_one, int corners_of_other>
HWY_NOINLINE std::uint64_t meeting_masks(const MovingBoxBlock& ones, std::uint64_t some_ones,
                                         const MovingBoxBlock& others, std::uint64_t some_others,
                                         std::size_t first, bool skips_neighbours, bool at_rest,
                                         std::uint64_t* masks) {
  std::uint64_t found = 0;
  for (; some_ones != 0; some_ones &= some_ones - 1) {
    const auto one = static_cast<std::size_t>(std::countr_zero(some_ones));
    MovingBox box;
    for (std::size_t side = 0; side < 6; ++side) {
      box.start[side] = ones.start[side][one];
      if (!at_rest) box.end[side] = ones.end[side][one];
    }
    std::uint64_t hits = meeting_group(box, others, at_rest, first) & some_others;
    if (skips_neighbours && hits != 0)
      hits &= ~neighbours_in_group<corners_of_one, corners_of_other>(ones, one, others, first);
    masks[one] = hits;
    found |= std::uint64_t{hits != 0} << one;
  }
  return found;
}

/// One call of `find_element_box_pairs`.
class ElementTests {
 public:
  ElementTests(const MovingView& a, const MovingView& b, const PartOfStep& part, bool same_object,
               MovingBoxCache& cache, ElementPairBatches& batches)
      : a_(a),
        b_(b),
        part_a_{0, part.latest, {}, part.kinds},
        part_b_(part),
        part_of_crossing_{part.crossing_separation, part.latest, part.offset, part.kinds},
        crossing_side_(same_object && part.crossing_separation == 0 ? cache.a : cache.crossing),
        at_rest_(are_at_rest(a, b, part)),
        same_object_(same_object),
        cache_(cache),
        batches_(batches) {
    if (std::exchange(cache.latest, part.latest) != part.latest) cache.clear();
  }

  void test(const LeafPair& leaves) {
    same_leaf_ = same_object_ && leaves.begin_a == leaves.begin_b;
    box_a_ = moving_box(child_boxes(a_, leaves.leaf_a / node_width, at_rest_), leaves.leaf_a % node_width,
                        part_a_);
    box_b_ = moving_box(child_boxes(b_, leaves.leaf_b / node_width, at_rest_), leaves.leaf_b % node_width,
                        part_b_);
    const auto [vertices_a, edges_a, faces_a] = elements_of(a_, leaves.begin_a, leaves.end_a);
    const auto [vertices_b, edges_b, faces_b] = elements_of(b_, leaves.begin_b, leaves.end_b);
    if (part_b_.kinds != ElementKinds::edge_edge) {
      match<Kind::vertex_face>(vertices_a, faces_b);
      if (!same_leaf_) match<Kind::face_vertex>(faces_a, vertices_b);
    }
    if (part_b_.kinds != ElementKinds::vertex_face) match<Kind::edge_edge>(edges_a, edges_b);
    if (part_b_.crossing_separation < 0) return;
    box_b_ = moving_box(child_boxes(b_, leaves.leaf_b / node_width, at_rest_), leaves.leaf_b % node_width,
                        part_of_crossing_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (box_b_.start[axis] > box_a_.start[axis + 3] || box_b_.start[axis + 3] < box_a_.start[axis]) return;
    }
    match<Kind::edge_face>(edges_a, faces_b);
    if (!same_leaf_) match<Kind::face_edge>(faces_a, edges_b);
  }
  std::uint64_t box_tests() const { return tests_; }

 private:
  using Kind = CandidateKind;

  /// The elements of one kind that a leaf owns.
  template <class Ids>
  struct Elements {
    Ids ids;
    MovingBoxCache::Kind MovingBoxCache::Side::*cache;
    ElementRange range;

    ElementRange block(std::uint32_t first) const { return {first, std::min(first + leaf_block, range.end)}; }
  };

  /// All elements of a leaf.
  struct LeafElements {
    Elements<VerticesThemselves> vertices;
    Elements<VerticesOfElements<2>> edges;
    Elements<VerticesOfElements<3>> faces;
  };
  static LeafElements elements_of(const MovingView& view, std::uint32_t begin, std::uint32_t end) {
    using Side = MovingBoxCache::Side;
    return {{{}, &Side::vertices, {view.first_vertex[begin], view.first_vertex[end]}},
            {{view.edge_ids}, &Side::edges, {view.first_edge[begin], view.first_edge[end]}},
            {{view.face_ids}, &Side::faces, {begin, end}}};
  }

  /// The boxes of a block of elements. Maps consecutive blocks to different places of the cache.
  template <class Ids>
  const MovingBoxBlock& boxes_of(const MovingView& view, const Elements<Ids>& elements,
                                 MovingBoxCache::Side& side, ElementRange block, const PartOfStep& part) {
    static_assert(MovingBoxCache::size == 32);
    const std::size_t place = block.begin * 0x9e3779b1u >> 27;
    MovingBoxCache::Kind& kind = side.*elements.cache;
    if (std::exchange(kind.first_elements[place], block.begin) != block.begin)
      set_block(view, elements.ids, block, part, same_object_, at_rest_, kind.blocks[place]);
    return kind.blocks[place];
  }

  template <Kind kind, class IdsA, class IdsB>
  void match(const Elements<IdsA>& all_a, const Elements<IdsB>& all_b) {
    constexpr bool may_cross = kind == Kind::edge_face || kind == Kind::face_edge;
    MovingBoxCache::Side& side_b = may_cross ? crossing_side_ : cache_.b;
    const PartOfStep& part_b = may_cross ? part_of_crossing_ : part_b_;
    for (std::uint32_t first_a = all_a.range.begin; first_a < all_a.range.end; first_a += leaf_block) {
      const ElementRange range_a = all_a.block(first_a);
      const MovingBoxBlock& boxes_a = boxes_of(a_, all_a, cache_.a, range_a, part_a_);
      const std::uint64_t some_a = near_leaf(box_b_, boxes_a, range_a);
      if (some_a == 0) continue;
      // Avoids finding each pair of edges of one leaf twice.
      const bool half = kind == Kind::edge_edge && same_leaf_;
      for (std::uint32_t first_b = half ? first_a : all_b.range.begin; first_b < all_b.range.end;
           first_b += leaf_block) {
        const ElementRange range_b = all_b.block(first_b);
        const MovingBoxBlock& boxes_b = boxes_of(b_, all_b, side_b, range_b, part_b);
        const std::uint64_t some_b = near_leaf(box_a_, boxes_b, range_b);
        if (some_b == 0) continue;
        const bool with_later = half && first_a == first_b;
        if (with_later || std::popcount(some_a) <= std::popcount(some_b)) {
          match_blocks<kind, false>(first_a, boxes_a, some_a, first_b, boxes_b, some_b, with_later);
        } else {
          match_blocks<kind, true>(first_b, boxes_b, some_b, first_a, boxes_a, some_a, false);
        }
      }
    }
  }

  /// Bits of the elements that may come near the other leaf.
  std::uint64_t near_leaf(const MovingBox& leaf, const MovingBoxBlock& boxes, ElementRange range) {
    if (same_leaf_) return ~std::uint64_t{0} >> (leaf_block - range.size());
    tests_ += range.size();
    return meeting_elements(leaf, boxes, at_rest_, range.size());
  }

  /// Tests each of `ones`, elements of a, or of b with `one_is_b`, against the others; in a block against
  /// itself only against later ones.
  template <Kind kind, bool one_is_b>
  void match_blocks(std::uint32_t first_one, const MovingBoxBlock& ones, std::uint64_t some_ones,
                    std::uint32_t first_other, const MovingBoxBlock& others, std::uint64_t some_others,
                    bool with_later) {
    constexpr int corners_a = kind == Kind::vertex_face                            ? 1
                              : kind == Kind::edge_edge || kind == Kind::edge_face ? 2
                                                                                   : 3;
    constexpr bool may_cross = kind == Kind::edge_face || kind == Kind::face_edge;
    constexpr int corners_b = (may_cross ? 5 : 4) - corners_a;
    std::array<std::uint64_t, leaf_block> masks;
    for (std::uint32_t i = 0; i < leaf_block; i += group) {
      const std::uint64_t some = some_others >> i & ((std::uint64_t{1} << group) - 1);
      if (some == 0) continue;
      tests_ += static_cast<std::uint64_t>(std::popcount(some_ones)) * group;
      std::uint64_t found = meeting_masks < one_is_b ? corners_b : corners_a,
                    one_is_b ? corners_a
                             : corners_b >
                                   (ones, some_ones, others, some, i, same_object_, at_rest_, masks.data());
      for (; found != 0; found &= found - 1) {
        const auto one = static_cast<std::uint32_t>(std::countr_zero(found));
        std::uint64_t hits = masks[one];
        if (with_later && one >= i) hits &= ~std::uint64_t{0} << std::min(one - i + 1, leaf_block - 1);
        add<kind, one_is_b>(first_one + one, first_other + i, hits);
      }
    }
  }

  /// Adds pairs of the element `one` of a, or of b with `of_b`, and the elements of the other object in
  /// `hits`, counted from `first`.
  template <Kind kind, bool of_b>
  void add(std::uint32_t one, std::uint32_t first, std::uint64_t hits) {
    // In pairs within one object the vertex or the edge comes before the face.
    const bool turned = same_object_ && (kind == Kind::face_vertex || kind == Kind::face_edge);
    const Kind reported = !turned ? kind : kind == Kind::face_vertex ? Kind::vertex_face : Kind::edge_face;
    ElementPair* const pairs = batches_.room_for(reported, group);
    std::size_t count = 0;
    for (; hits != 0; hits &= hits - 1) {
      const std::uint32_t other = first + static_cast<std::uint32_t>(std::countr_zero(hits));
      pairs[count++] = turned != of_b ? ElementPair{other, one} : ElementPair{one, other};
    }
    batches_.added(reported, count);
  }

  const MovingView& a_;
  const MovingView& b_;
  PartOfStep part_a_, part_b_, part_of_crossing_;
  MovingBoxCache::Side& crossing_side_;  ///< the boxes of b for crossings
  bool at_rest_, same_object_;
  MovingBoxCache& cache_;
  ElementPairBatches& batches_;
  bool same_leaf_ = false;
  MovingBox box_a_, box_b_;
  std::uint64_t tests_ = 0;
};

std::uint64_t ElementBoxPairs(const LeafPair* leaf_pairs, std::size_t count, const MovingView& a,
                              const MovingView& b, const PartOfStep& part, bool same_object,
                              MovingBoxCache& cache, ElementPairBatches& batches) {
  ElementTests tests(a, b, part, same_object, cache, batches);
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
                                     MovingBoxCache& cache, ElementPairBatches& batches) {
  return HWY_DYNAMIC_DISPATCH(ElementBoxPairs)(leaf_pairs.data(), leaf_pairs.size(), a, b, part, same_object,
                                               cache, batches);
}

}  // namespace supple
#endif
