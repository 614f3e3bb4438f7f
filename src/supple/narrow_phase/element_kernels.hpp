#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "narrow_phase/overlap_kernels.hpp"
#include "octree/volumes/moving_boxes.hpp"
#include "supple/contact.hpp"
#include "supple/options.hpp"

namespace supple {

/// Two elements of objects a and b, numbered in octree order: vertex and face, face and vertex, or two edges.
struct ElementPair {
  std::uint32_t a = 0, b = 0;
  constexpr auto operator<=>(const ElementPair&) const = default;
};

/// The kinds of candidates: those of `ElementPairKind`, and edges and faces that may cross.
enum class CandidateKind : std::uint8_t { vertex_face, face_vertex, edge_edge, edge_face, face_edge };

/// Collects candidates, one batch for each kind, and passes each full batch to a sink.
class ElementPairBatches {
 public:
  static constexpr std::size_t capacity = 1024;
  using Sink = void (*)(void* context, CandidateKind kind, std::span<const ElementPair> pairs);

  /// The receiver of the batches; borrowed until `flush`. Drops pairs that an exception has left behind.
  void set_sink(Sink sink, void* context) {
    sink_ = sink;
    context_ = context;
    for (Batch& batch : batches_) batch.count = 0;
  }
  /// Space for `count` more pairs of the kind; `count` is far below the capacity. The caller writes pairs
  /// there and passes their number to `added`.
  ElementPair* room_for(CandidateKind kind, std::size_t count) {
    Batch& batch = batches_[static_cast<std::size_t>(kind)];
    if (batch.count + count > capacity) hand_over(kind);
    return batch.pairs.data() + batch.count;
  }
  void added(CandidateKind kind, std::size_t count) {
    batches_[static_cast<std::size_t>(kind)].count += count;
  }
  /// Passes on all remaining pairs.
  void flush() {
    for (std::size_t kind = 0; kind < batches_.size(); ++kind) {
      if (batches_[kind].count > 0) hand_over(static_cast<CandidateKind>(kind));
    }
  }

 private:
  struct Batch {
    std::size_t count = 0;
    std::array<ElementPair, capacity> pairs;
  };
  void hand_over(CandidateKind kind) {
    Batch& batch = batches_[static_cast<std::size_t>(kind)];
    const std::size_t count = batch.count;
    batch.count = 0;
    sink_(context_, kind, {batch.pairs.data(), count});
  }

  std::array<Batch, 5> batches_;
  Sink sink_ = nullptr;
  void* context_ = nullptr;
};

/// The shortest part of a step in which moving boxes are searched.
constexpr float least_part_of_step = 0x1p-120f;

/// Parameters of the test of moving boxes: whether they come within `separation` of each other until the time
/// `latest`, from that part to 1. The boxes of b are moved by `offset`; the separation covers the rounding
/// errors of this.
struct PartOfStep {
  float separation = 0;
  float latest = 1;
  Vec3f offset{};
  ElementKinds kinds = ElementKinds::all;  ///< pairs of elements that are tested
  /// For objects at rest: also tests edges against faces, with this separation of their boxes, which covers
  /// only the rounding errors. Negative: does not.
  float crossing_separation = -1;
  /// Elements move so little against each other that the separation covers it: only boxes at the start count.
  bool at_start = false;
  float size = 0;  ///< of the leaves

  /// Whether boxes stay as they are: the whole step, with neither a separation nor an offset.
  bool keeps_boxes() const { return !(separation > 0 || latest < 1) && offset == Vec3f{}; }
};

/// Boxes of up to `leaf_block` elements of one kind at both ends of (a part of) a step: min x, y, z, max x,
/// y, z. In tests of an object with itself also the vertices of each element, one array for each corner.
/// Entries past the last element are unspecified.
struct alignas(64) MovingBoxBlock {
  float start[6][leaf_block], end[6][leaf_block];
  std::uint32_t vertices[3][leaf_block];
};

/// A cache of the boxes of the elements of recent leaves, for vertices, edges and faces; most are soon used
/// again. Valid for one pair of objects on their paths; clear it for others.
struct MovingBoxCache {
  static constexpr std::size_t size = 32;
  struct Kind {
    std::array<std::uint32_t, size> first_elements;
    std::array<MovingBoxBlock, size> blocks;
  };
  struct Side {
    Kind vertices, edges, faces;
  };
  Side a, b;
  Side crossing;     ///< those of b with the `crossing_separation`
  float latest = 1;  ///< of the `PartOfStep`

  MovingBoxCache() { clear(); }
  void clear() {
    clear_b();
    for (Kind* const kind : {&a.vertices, &a.edges, &a.faces}) kind->first_elements.fill(~std::uint32_t{0});
  }
  /// For another separation.
  void clear_b() {
    for (Side* const side : {&b, &crossing}) {
      for (Kind* const kind : {&side->vertices, &side->edges, &side->faces})
        kind->first_elements.fill(~std::uint32_t{0});
    }
  }
};

/// `overlap_masks` for moving nodes: sets the bits of children that may come within the separation.
void moving_overlap_masks(std::span<const NodePair> pairs, const MovingView& a, const MovingView& b,
                          const PartOfStep& part, std::uint64_t* masks);

/// Adds all pairs of elements of the leaf pairs that may come within the separation of each other, by their
/// boxes at both ends of the step; with a `crossing_separation` also the edges and faces whose boxes overlap.
/// With `same_object`, skips pairs that share a vertex, adds each pair once, and faces are always b. Never
/// misses a pair. Returns the number of box tests.
///
/// Only elements near the box of the other leaf are tested: those of the side that has fewer, one at a time,
/// against vectors of elements of the other side.
std::uint64_t find_element_box_pairs(std::span<const LeafPair> leaf_pairs, const MovingView& a,
                                     const MovingView& b, const PartOfStep& part, bool same_object,
                                     MovingBoxCache& cache, ElementPairBatches& batches);

}  // namespace supple
