#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/box_kernels.hpp"
#include "octree/octree_node.hpp"
#include "supple/types.hpp"

namespace supple {

/// Two nodes whose children are to be tested against each other: bit i of `children_a` is child i of a.
struct NodePair {
  std::uint32_t a = 0, b = 0;
  std::uint8_t children_a = 0xff, children_b = 0xff;
};

/// Where object b lies against object a, when objects were translated: b's volumes move by `offset` and grow
/// by `slop`, which covers every rounding on the way. Zero for objects at their own positions.
struct RelativePlacement {
  Vec3f offset;
  float slop = 0;

  bool is_identity() const { return offset == Vec3f{} && slop == 0; }
};

/// Triangles of two leaves whose volumes overlap, in octree order: [begin_a, end_a) against [begin_b, end_b).
/// Within one leaf of one object the ranges are equal. `leaf_a` and `leaf_b` are the leaves: eight times
/// the node plus the child.
struct LeafPair {
  std::uint32_t begin_a = 0, end_a = 0, begin_b = 0, end_b = 0;
  std::uint32_t leaf_a = 0, leaf_b = 0;
};

/// Triangles of a leaf that are tested at a time: a bit each. Larger leaves are taken in such blocks.
constexpr std::uint32_t leaf_block = 64;

/// Boxes of the triangles of a block, one array an axis and side. Those past the last triangle hold anything.
struct alignas(64) LeafBoxes {
  float min_x[leaf_block], min_y[leaf_block], min_z[leaf_block];
  float max_x[leaf_block], max_y[leaf_block], max_z[leaf_block];
  std::uint64_t triangles;  ///< bit i: there is a triangle i, and it is not inert
  std::uint32_t size;       ///< triangles, inert ones included
};

/// A cache of the boxes of recent blocks, most of which are used again soon. Valid for one pair of objects
/// in their positions; clear it for others. 100 KB, for the second-level cache.
class LeafBoxCache {
 public:
  static constexpr std::size_t size = 32;

  LeafBoxCache() { clear(); }
  void clear() {
    a_.first_triangles.fill(none);
    b_.first_triangles.fill(none);
  }
  struct Side {
    std::array<std::uint32_t, size> first_triangles;
    std::array<LeafBoxes, size> boxes;
  };
  Side& a() { return a_; }
  Side& b() { return b_; }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  Side a_, b_;
};

/// Candidates on their way. Memory is taken only where there are more of them than ever before.
class TrianglePairList {
 public:
  /// Where `count` more pairs can be written; how many of them there are is then told by `added`.
  TrianglePair* room_for(std::size_t count) {
    if (pairs_.size() < count_ + count) pairs_.resize(2 * (count_ + count));
    return pairs_.data() + count_;
  }
  void added(std::size_t count) { count_ += count; }
  std::size_t size() const { return count_; }
  std::span<const TrianglePair> pairs() const { return {pairs_.data(), count_}; }
  void clear() { count_ = 0; }

 private:
  std::vector<TrianglePair> pairs_;
  std::size_t count_ = 0;
};

/// Bit 8 i + j of `masks[k]`: child i of node a and child j of node b of `pairs[k]` may overlap. Children
/// outside `children_a` give no bits; bits of missing children of b have any value. Never misses an overlap.
void overlap_masks(std::span<const NodePair> pairs, const ChildBoxes* a, const ChildBoxes* b,
                   const RelativePlacement& placement, std::uint64_t* masks);
void overlap_masks(std::span<const NodePair> pairs, const ChildSpheres* a, const ChildSpheres* b,
                   const RelativePlacement& placement, std::uint64_t* masks);

/// What the leaf tests read of an object: its triangles, and the boxes and vertices of its leaves.
struct LeafArrays {
  const TriangleArrays& triangles;
  const ChildBoxes* boxes = nullptr;
  LeafVertexArrays vertices;
};

/// Appends all pairs of triangles of the leaf pairs whose boxes may overlap, in octree order's numbers; inert
/// triangles are in none. With `same_object` pairs that share a vertex are left out and each pair comes once,
/// a < b or b < a. Never misses an overlap. Returns the number of box tests.
///
/// Of each leaf, only triangles count that meet the box of the other; these are tested one by one, those of
/// the side that has fewer, against vectors of the other side's.
std::uint64_t find_triangle_box_pairs(std::span<const LeafPair> leaf_pairs, const LeafArrays& a,
                                      const LeafArrays& b, const RelativePlacement& placement,
                                      bool same_object, LeafBoxCache& cache, TrianglePairList& pairs);

}  // namespace supple
