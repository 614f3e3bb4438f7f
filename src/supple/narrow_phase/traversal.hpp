#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/stop_signal.hpp"
#include "narrow_phase/element_kernels.hpp"
#include "narrow_phase/overlap_kernels.hpp"
#include "octree/moving_boxes.hpp"
#include "octree/object_octree.hpp"

namespace supple {

/// What the narrow phase reads of one object; borrowed for the call.
struct OctreeView {
  std::span<const OctreeNode> nodes;
  const ChildBoxes* boxes = nullptr;
  const ChildSpheres* spheres = nullptr;  ///< null: the boxes are the volumes
  TriangleArrays arrays;
  LeafVertexArrays leaf_vertices;
  Aabb box;           ///< of all positions
  Vec3d translation;  ///< added to each position
  MovingView moving;  ///< of objects in motion, of which `arrays` and `leaf_vertices` are not read
  /// Masks of a `SelfCollisionCulling` at these positions, or null: the search of an object against itself
  /// skips children that cannot touch themselves. It finds fewer candidates, but all contacts.
  const std::uint8_t* culled = nullptr;
};
OctreeView view_of(const ObjectOctree& octree, const VertexBuffer& vertices,
                   std::span<const std::uint8_t> inert, Vec3d translation);
/// Of an object in motion, at rest or not; `boxes` are refitted. Translated objects are at rest.
OctreeView moving_view_of(const ObjectOctree& octree, const SurfaceElements& elements,
                          const MovingBoxes& boxes, Vec3d translation);

/// Two objects, or one with itself (`same_object`, a and b being the same view).
struct ObjectPairView {
  OctreeView a, b;
  RelativePlacement placement;
  bool same_object = false;
  /// For objects in motion: elements touch when their boxes come this close. At least the requested
  /// separation and the slop of the placement.
  float separation = 0;
  /// Null, or up to when in the step elements that touch are of interest; it may fall while they are looked
  /// for.
  const std::atomic<float>* latest = nullptr;

  /// Bounds between the two ends cost more than those at the ends, and a large part of the step saves little.
  PartOfStep part_of_step() const {
    constexpr float least = 0x1p-20f, most = 0.125f;
    const float until = latest != nullptr ? latest->load(std::memory_order_relaxed) : 1;
    return {separation, until < most ? std::max(until, least) : 1, placement.offset};
  }
  bool is_moving() const { return a.moving.start != nullptr; }
};
ObjectPairView pair_of(const OctreeView& a, const OctreeView& b);
ObjectPairView self_pair_of(const OctreeView& object);
/// The same of moving views; `separation` ≥ 0, not NaN.
ObjectPairView moving_pair_of(const OctreeView& a, const OctreeView& b, double separation);
ObjectPairView moving_self_pair_of(const OctreeView& object, double separation);

struct TraversalStats {
  std::uint64_t node_pairs_visited = 0;
  std::uint64_t volumes_tested = 0;
  std::uint64_t candidate_pairs = 0;
  /// Of objects in motion, for which `candidate_pairs` stays.
  std::uint64_t vertex_face_candidates = 0, edge_edge_candidates = 0;
};

/// Two children that the descent compares.
struct ChildPair {
  std::uint32_t node_a = 0, node_b = 0;
  int child_a = 0, child_b = 0;
  bool apart = false;  ///< the volumes are: the descent ends here
};
/// Where the descent from the roots to two triangles ends, octree order's numbers: at the first children on
/// the way that are apart, or else at the two leaves. Of one object with itself, `triangles.a < triangles.b`.
ChildPair last_children(const ObjectPairView& pair, TrianglePair triangles);
/// Whether the narrow phase tells two triangles of two leaves apart by their boxes, as `find_triangle_pairs`
/// would.
bool leaf_triangles_apart(const ObjectPairView& pair, const ChildPair& leaves, TrianglePair triangles);

/// Octree against octree, both descended at once. Holds the scratch memory of one worker, kept between calls.
///
/// The work is a stack of node pairs, tested in batches: eight children against eight, 64 bits per pair. Two
/// inner children become a pair of nodes; a leaf against an inner child becomes the leaf's node, restricted
/// to that child, against the other's node; two leaves become a leaf pair.
class Traversal {
 public:
  /// Searches end early, and find part of what there is, once a stop is requested.
  void set_stop(const StopSignal& stop) { stop_ = stop; }

  /// Calls `sink(std::span<const TrianglePair>)` with batches of candidates in octree order's numbers: all
  /// triangle pairs whose boxes overlap, below `root` (all of them: a default `NodePair`). `on_leaves(leaf
  /// pairs)` sees the pairs of leaves they come from. Never misses a pair; memory does not grow with their
  /// number.
  template <class OnLeaves, class Sink>
  void find_triangle_pairs(const ObjectPairView& pair, NodePair root, TraversalStats& stats,
                           OnLeaves&& on_leaves, Sink&& sink) {
    if (pair.a.nodes.empty() || pair.b.nodes.empty()) return;
    stack_.assign(1, root);
    leaf_pairs_.clear();
    leaf_boxes_.clear();
    while (!stack_.empty() && !stop_.stop_requested()) {
      expand_batch(pair, stats);
      if (leaf_pairs_.size() >= leaf_batch || stack_.empty()) {
        on_leaves(std::span<const LeafPair>(leaf_pairs_));
        flush_leaves(pair, stats, sink);
      }
    }
  }

  /// The same of objects in motion: calls `sink(ElementPairKind, std::span<const ElementPair>)` with batches
  /// of candidates, octree order's numbers, of at most `ElementPairBatches::capacity`. These are all
  /// vertex-face, face-vertex and edge-edge pairs whose boxes are not apart by more than the separation, on
  /// one side of one axis, at both ends of the step. Of one object with itself those that share a vertex are
  /// left out, and there is no `face_vertex`. Each pair comes once, over all the roots of a `refine`.
  template <class Sink>
  void find_element_pairs(const ObjectPairView& pair, NodePair root, TraversalStats& stats, Sink&& sink) {
    if (pair.a.nodes.empty() || pair.b.nodes.empty()) return;
    auto count_and_sink = [&](ElementPairKind kind, std::span<const ElementPair> pairs) {
      (kind == ElementPairKind::edge_edge ? stats.edge_edge_candidates : stats.vertex_face_candidates) +=
          pairs.size();
      sink(kind, pairs);
    };
    element_pairs_.set_sink(
        [](void* context, ElementPairKind kind, std::span<const ElementPair> pairs) {
          (*static_cast<decltype(count_and_sink)*>(context))(kind, pairs);
        },
        &count_and_sink);
    stack_.assign(1, root);
    leaf_pairs_.clear();
    while (!stack_.empty() && !stop_.stop_requested()) {
      expand_batch(pair, stats);
      if (leaf_pairs_.size() < leaf_batch && !stack_.empty()) continue;
      stats.volumes_tested += find_element_box_pairs(leaf_pairs_, pair.a.moving, pair.b.moving,
                                                     pair.part_of_step(), pair.same_object, element_pairs_);
      leaf_pairs_.clear();
    }
    element_pairs_.flush();
  }

  /// Calls `on_leaves(std::span<const LeafPair>)` with all pairs of leaves whose volumes overlap, in motion
  /// or not.
  template <class OnLeaves>
  void find_leaf_pairs(const ObjectPairView& pair, TraversalStats& stats, OnLeaves&& on_leaves) {
    if (pair.a.nodes.empty() || pair.b.nodes.empty()) return;
    stack_.assign(1, NodePair{});
    while (!stack_.empty()) {
      leaf_pairs_.clear();
      expand_batch(pair, stats);
      on_leaves(std::span<const LeafPair>(leaf_pairs_));
    }
  }

  /// One step of the descent for all of `pairs`, for spreading work over threads: what it appends to `finer`
  /// finds the same triangle pairs. Pairs that involve a leaf stay as they are, restricted to the two
  /// children.
  void refine(const ObjectPairView& pair, NodePair node_pair, std::vector<NodePair>& finer);

 private:
  static constexpr std::size_t node_batch = 64;
  static constexpr std::size_t leaf_batch = 256;
  static constexpr std::size_t candidate_batch = 1024;

  void expand_batch(const ObjectPairView& pair, TraversalStats& stats);

  template <class Sink>
  void flush_leaves(const ObjectPairView& pair, TraversalStats& stats, Sink&& sink) {
    constexpr std::size_t step = 32;
    const LeafArrays a{pair.a.arrays, pair.a.boxes, pair.a.leaf_vertices},
        b{pair.b.arrays, pair.b.boxes, pair.b.leaf_vertices};
    for (std::size_t i = 0; i < leaf_pairs_.size(); i += step) {
      const auto part =
          std::span<const LeafPair>(leaf_pairs_).subspan(i, std::min(step, leaf_pairs_.size() - i));
      stats.volumes_tested +=
          find_triangle_box_pairs(part, a, b, pair.placement, pair.same_object, leaf_boxes_, candidates_);
      if (candidates_.size() >= candidate_batch || i + step >= leaf_pairs_.size()) {
        stats.candidate_pairs += candidates_.size();
        if (candidates_.size() > 0) sink(candidates_.pairs());
        candidates_.clear();
      }
    }
    leaf_pairs_.clear();
  }

  StopSignal stop_;
  std::vector<NodePair> stack_;
  std::array<std::uint64_t, node_batch> masks_;
  std::array<NodePair, node_batch> batch_;
  std::vector<LeafPair> leaf_pairs_;
  LeafBoxCache leaf_boxes_;
  TrianglePairList candidates_;
  ElementPairBatches element_pairs_;
};

}  // namespace supple
