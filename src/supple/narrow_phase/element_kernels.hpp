#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "narrow_phase/overlap_kernels.hpp"
#include "octree/moving_boxes.hpp"
#include "supple/contact.hpp"

namespace supple {

/// Two elements in octree order's numbers: vertex and face, face and vertex or two edges of objects a and b.
struct ElementPair {
  std::uint32_t a = 0, b = 0;
  constexpr auto operator<=>(const ElementPair&) const = default;
};

/// Candidates on their way to whoever tests them: a batch a kind, handed over when full.
class ElementPairBatches {
 public:
  static constexpr std::size_t capacity = 1024;
  using Sink = void (*)(void* context, ElementPairKind kind, std::span<const ElementPair> pairs);

  /// Whom the batches go to; borrowed until `flush`.
  void set_sink(Sink sink, void* context) {
    sink_ = sink;
    context_ = context;
  }
  /// Where `count` more pairs of the kind can be written, `count` being far below the capacity; how many of
  /// them there are is then told by `added`.
  ElementPair* room_for(ElementPairKind kind, std::size_t count) {
    Batch& batch = batches_[static_cast<std::size_t>(kind)];
    if (batch.count + count > capacity) hand_over(kind);
    return batch.pairs.data() + batch.count;
  }
  void added(ElementPairKind kind, std::size_t count) {
    batches_[static_cast<std::size_t>(kind)].count += count;
  }
  /// Hands over what is left.
  void flush() {
    for (std::size_t kind = 0; kind < batches_.size(); ++kind) {
      if (batches_[kind].count > 0) hand_over(static_cast<ElementPairKind>(kind));
    }
  }

 private:
  struct Batch {
    std::size_t count = 0;
    std::array<ElementPair, capacity> pairs;
  };
  void hand_over(ElementPairKind kind) {
    Batch& batch = batches_[static_cast<std::size_t>(kind)];
    const std::size_t count = batch.count;
    batch.count = 0;
    sink_(context_, kind, {batch.pairs.data(), count});
  }

  std::array<Batch, 3> batches_;
  Sink sink_ = nullptr;
  void* context_ = nullptr;
};

/// What boxes in motion are tested for: coming within `separation` of each other, not after `latest`, which
/// is from 2^-20 to 1. The boxes of b lie `offset` from where they are stored; the separation covers the
/// roundings of that.
struct PartOfStep {
  float separation = 0;
  float latest = 1;
  Vec3f offset{};
};

/// As `overlap_masks`, for nodes in motion: the bits of children that come within the separation at some
/// time.
void moving_overlap_masks(std::span<const NodePair> pairs, const MovingView& a, const MovingView& b,
                          const PartOfStep& part, std::uint64_t* masks);

/// Adds all pairs of elements of the leaf pairs that may come within the separation of each other, by their
/// boxes at both ends of the step. With `same_object` pairs that share a vertex are left out, each pair comes
/// once and faces are always b. Never misses a pair. Returns the number of box tests.
std::uint64_t find_element_box_pairs(std::span<const LeafPair> leaf_pairs, const MovingView& a,
                                     const MovingView& b, const PartOfStep& part, bool same_object,
                                     ElementPairBatches& batches);

}  // namespace supple
