#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/node_pair.hpp"
#include "octree/octree_node.hpp"
#include "octree/volumes/box_kernels.hpp"
#include "supple/types.hpp"

namespace supple {

/// Triangles of two leaves whose volumes overlap, in octree order: [begin_a, end_a) against [begin_b, end_b).
/// A leaf against itself has equal ranges. `leaf_a` and `leaf_b` are eight times the node plus the child.
struct LeafPair {
  std::uint32_t begin_a = 0, end_a = 0, begin_b = 0, end_b = 0;
  std::uint32_t leaf_a = 0, leaf_b = 0;
};

/// The greatest number of triangles of a leaf in one test, one bit for each. Larger leaves have several
/// blocks.
constexpr std::uint32_t leaf_block = 64;

/// Boxes of the triangles of a block, one array for each axis and side. Entries past the last triangle are
/// unspecified.
struct alignas(64) LeafBoxes {
  float min_x[leaf_block], min_y[leaf_block], min_z[leaf_block];
  float max_x[leaf_block], max_y[leaf_block], max_z[leaf_block];
  std::uint64_t triangles;  ///< bit i: triangle i exists and is not inert
  std::uint32_t size;       ///< number of triangles, with the inert ones

  Aabb box(std::uint32_t i) const { return {{min_x[i], min_y[i], min_z[i]}, {max_x[i], max_y[i], max_z[i]}}; }
};

/// A cache of the boxes of recent blocks; most are soon used again. Valid for one pair of objects at their
/// positions; clear it for others. Its 100 KB fit into the second-level cache.
struct LeafBoxCache {
  static constexpr std::size_t size = 32;
  struct Side {
    std::array<std::uint32_t, size> first_triangles;
    std::array<LeafBoxes, size> boxes;
  };
  Side a, b;

  LeafBoxCache() { clear(); }
  void clear() {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    a.first_triangles.fill(none);
    b.first_triangles.fill(none);
  }
};

/// A list of candidates. Allocates memory only when it holds more candidates than ever before.
class TrianglePairList {
 public:
  /// Space for `count` more pairs. The caller writes pairs there and passes their number to `added`.
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

/// Bit 8 i + j of `masks[k]`: child i of node a and child j of node b of `pairs[k]` may overlap. Bits of
/// children outside `children_a` are 0; bits of missing children of b are unspecified. Never misses an
/// overlap.
void overlap_masks(std::span<const NodePair> pairs, const ChildBoxes* a, const ChildBoxes* b,
                   const RelativePlacement& placement, std::uint64_t* masks);

/// The data of an object for the leaf tests: its triangles, and the boxes and vertices of its leaves.
struct LeafArrays {
  const TriangleArrays& triangles;
  const ChildBoxes* boxes = nullptr;
  LeafVertexArrays vertices;
};

/// Computes the boxes of the triangles [begin, end) of a leaf, at most a block, in octree order. `leaf` is
/// eight times the node plus the child.
void load_leaf_boxes(const LeafArrays& object, std::uint32_t leaf, std::uint32_t begin, std::uint32_t end,
                     LeafBoxes& boxes);

/// The children or triangles whose boxes overlap the box; bits of missing children are unspecified.
std::uint32_t overlapping_children(const Aabb& box, const ChildBoxes& boxes);
std::uint64_t overlapping_triangles(const Aabb& box, const LeafBoxes& boxes);

/// Appends all pairs of triangles of the leaf pairs whose boxes may overlap, numbered in octree order. Skips
/// inert triangles. With `same_object`, skips pairs that share a vertex and appends each pair once, a < b or
/// b < a. Never misses an overlap. Returns the number of box tests.
///
/// Only triangles that overlap the box of the other leaf are tested: one at a time from the side that has
/// fewer, against vectors of triangles of the other side.
std::uint64_t find_triangle_box_pairs(std::span<const LeafPair> leaf_pairs, const LeafArrays& a,
                                      const LeafArrays& b, const RelativePlacement& placement,
                                      bool same_object, LeafBoxCache& cache, TrianglePairList& pairs);

}  // namespace supple
