#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/float_rounding.hpp"
#include "core/stop_signal.hpp"
#include "narrow_phase/element_kernels.hpp"
#include "narrow_phase/overlap_kernels.hpp"
#include "octree/object_octree.hpp"
#include "octree/volumes/moving_boxes.hpp"

namespace supple {

/// The data of one object for the narrow phase; borrowed for the call.
struct OctreeView {
  std::span<const OctreeNode> nodes;
  std::span<const std::uint64_t> cell_numbers;  ///< `OctreeTopology::numbers`
  const ChildBoxes* boxes = nullptr;
  const NodeVolumes* volumes = nullptr;  ///< null: the boxes are the volumes
  TriangleArrays arrays;
  LeafVertexArrays leaf_vertices;
  Aabb box;                               ///< of all positions
  Descent descent = Descent::both_sides;  ///< of objects at rest
  Vec3d translation;                      ///< added to each position
  /// Boxes of the ways of the vertices in each child, for `ObjectPairView::kept_share`; null at rest.
  const ChildBoxes* ways = nullptr;
  MovingView moving;  ///< for moving objects, which do not use `arrays` and `leaf_vertices`
  /// Masks of a `SelfCollisionCulling` for these positions, or null. An object against itself then skips
  /// children that cannot touch themselves. This loses candidates, but no contacts.
  const std::uint8_t* culled = nullptr;
};
OctreeView view_of(const ObjectOctree& octree, const VertexBuffer& vertices,
                   std::span<const std::uint8_t> inert, Vec3d translation);
/// For continuous contacts, also of an object at rest; `boxes` are refitted. Translated objects are at rest.
OctreeView moving_view_of(const ObjectOctree& octree, const SurfaceElements& elements,
                          const MovingBoxes& boxes, Vec3d translation);

/// Two children that the descent compares.
struct ChildPair {
  std::uint32_t node_a = 0, node_b = 0;
  int child_a = 0, child_b = 0;
};

/// Two objects, or one with itself: with `same_object`, a and b are the same view.
struct ObjectPairView {
  OctreeView a, b;
  RelativePlacement placement;
  bool same_object = false;
  /// For moving objects: the distance of boxes within which elements may touch. At least the requested
  /// separation and the slop of the placement.
  float separation = 0;
  /// Null, or the time in the step until which contacts are of interest. It may decrease during the search.
  const std::atomic<float>* latest = nullptr;
  /// The search passes on elements that may come near soon first; it may repeat pairs. Needs `latest`.
  bool soonest_first = false;
  /// Added to the separation, times that time.
  double growth = 0;
  /// Share of the largest approach of two vertices of two children that is added to their separation.
  double kept_share = 0;
  /// The two children may move by any parts of their ways, so that the sum of both ways counts instead of the
  /// approach.
  bool any_parts = false;
  ElementKinds kinds = ElementKinds::all;  ///< for moving objects
  /// For objects at rest: edges and faces whose boxes overlap are candidates, too.
  bool with_crossings = false;

  /// Bounds at a time before the end cost more than those at the end, and for a late time they save little.
  PartOfStep part_of_step() const {
    constexpr float most = 0.125f;
    const float latest_now = latest != nullptr ? latest->load(std::memory_order_relaxed) : 1;
    const float until = latest_now < most ? std::max(latest_now, least_part_of_step) : 1;
    return {growth > 0 ? round_up(separation + growth * until) : separation, until, placement.offset, kinds,
            with_crossings ? placement.slop : -1};
  }
  /// The same for two children and a time, with the separation that `kept_share` asks for.
  PartOfStep part_until(const ChildPair& children, float until) const;
  bool is_moving() const { return a.moving.start != nullptr; }
};
/// One object with itself when both are the same view. `separation` ≥ 0, not NaN, is for moving views.
ObjectPairView pair_of(const OctreeView& a, const OctreeView& b, double separation = 0);

/// Whether the `NodeVolumes` of two objects that have some are apart.
bool object_volumes_apart(const ObjectPairView& pair);

struct TraversalStats {
  std::uint64_t node_pairs_visited = 0;
  std::uint64_t volumes_tested = 0;
  std::uint64_t candidate_pairs = 0;
  /// For moving objects, which do not change `candidate_pairs`.
  std::uint64_t vertex_face_candidates = 0, edge_edge_candidates = 0;
};

/// One step of the descent: the pairs of children of two nodes whose volumes overlap.
void find_overlapping_children(const ObjectPairView& pair, NodePair node_pair,
                               std::vector<ChildPair>& children);
/// The next nodes of the descent below two children that overlap; nothing below two leaves.
std::optional<NodePair> nodes_below(const ObjectPairView& pair, const ChildPair& children);

/// Octree against octree, both descended at once. Holds the scratch memory of one worker, kept between calls.
///
/// The work is a stack of node pairs, tested in batches: eight children against eight, 64 bits per pair. Two
/// inner children become a pair of nodes; a leaf against an inner child becomes the leaf's node, restricted
/// to that child, against the other's node; two leaves become a leaf pair.
class Traversal {
 public:
  /// After a request to stop, searches end early with part of the results.
  void set_stop(const StopSignal& stop) { stop_ = stop; }
  /// The part of the step in which the pairs come near that the sink has; other pairs may follow.
  float until() const { return until_; }

  /// Calls `sink(std::span<const TrianglePair>)` with batches of candidates, numbered in octree order: all
  /// triangle pairs below `root` whose boxes overlap. A default `NodePair` is the root of both trees. Calls
  /// `on_leaves(leaf pairs)` with the pairs of leaves that contain them. Never misses a pair. Memory does not
  /// grow with the number of pairs.
  template <class OnLeaves, class Sink>
  void find_triangle_pairs(const ObjectPairView& pair, NodePair root, TraversalStats& stats,
                           OnLeaves&& on_leaves, Sink&& sink) {
    leaf_boxes_.clear();
    candidates_.clear();  // an exception may have left some there
    descend(pair, root, stats, [&](std::span<const LeafPair> leaves) {
      on_leaves(leaves);
      test_leaves(pair, leaves, stats, sink);
    });
  }

  /// The same for moving objects: calls `sink(ElementPairKind, std::span<const ElementPair>)` with batches of
  /// at most `ElementPairBatches::capacity` candidates, numbered in octree order. These are all vertex-face,
  /// face-vertex and edge-edge pairs, except those whose boxes are apart by more than the separation on the
  /// same side of one axis at both ends of the step. For one object with itself, pairs that share a vertex
  /// and the kind `face_vertex` do not occur. Each pair occurs once among all roots of a `refine`, except
  /// with `soonest_first`.
  template <class Sink>
  void find_element_pairs(const ObjectPairView& pair, NodePair root, TraversalStats& stats, Sink&& sink) {
    find_element_pairs(pair, root, stats, sink, [](bool, std::span<const ElementPair>) {});
  }
  /// With crossings, also calls `crossing_sink(bool edge_is_of_a, std::span<const ElementPair>)`
  /// with the edges and faces whose boxes overlap; within one object, the edge is always a.
  template <class Sink, class CrossingSink>
  void find_element_pairs(const ObjectPairView& pair, NodePair root, TraversalStats& stats, Sink&& sink,
                          CrossingSink&& crossing_sink) {
    auto count_and_sink = [&](CandidateKind kind, std::span<const ElementPair> pairs) {
      if (kind > CandidateKind::edge_edge) return crossing_sink(kind == CandidateKind::edge_face, pairs);
      (kind == CandidateKind::edge_edge ? stats.edge_edge_candidates : stats.vertex_face_candidates) +=
          pairs.size();
      sink(static_cast<ElementPairKind>(kind), pairs);
    };
    element_pairs_.set_sink(
        [](void* context, CandidateKind kind, std::span<const ElementPair> pairs) {
          (*static_cast<decltype(count_and_sink)*>(context))(kind, pairs);
        },
        &count_and_sink);
    if (element_boxes_ == nullptr) element_boxes_ = std::make_unique<MovingBoxCache>();
    element_boxes_->clear();
    const auto find_pairs = [&](std::span<const LeafPair> leaves, const PartOfStep& part) {
      stats.volumes_tested += find_element_box_pairs(leaves, pair.a.moving, pair.b.moving, part,
                                                     pair.same_object, *element_boxes_, element_pairs_);
    };
    until_ = 1;
    if (!pair.soonest_first) {
      descend(pair, root, stats,
              [&](std::span<const LeafPair> leaves) { find_pairs(leaves, pair.part_of_step()); });
    } else if (!pair.a.nodes.empty() && !pair.b.nodes.empty()) {
      find_in_time(pair, root, stats, find_pairs);
    }
    element_pairs_.flush();
  }

  /// Calls `on_leaves(std::span<const LeafPair>)` with all pairs of leaves whose volumes overlap, for moving
  /// and other objects.
  template <class OnLeaves>
  void find_leaf_pairs(const ObjectPairView& pair, TraversalStats& stats, OnLeaves&& on_leaves) {
    descend(pair, {}, stats, on_leaves);
  }

  /// One step of the descent, to divide work among threads. The node pairs that it appends to `finer` lead to
  /// the same triangle pairs. Pairs that involve a leaf stay at their nodes, restricted to the two children.
  void refine(const ObjectPairView& pair, NodePair node_pair, std::vector<NodePair>& finer);

 private:
  static constexpr std::size_t node_batch = 64;
  static constexpr std::size_t leaf_batch = 256;
  static constexpr std::size_t candidate_batch = 1024;

  /// What waits for its time: elements of the nodes come near no earlier.
  struct Waiting {
    double time;
    std::uint32_t number;  ///< the last of those with the same time comes first
    NodePair nodes;
    bool operator<(const Waiting& other) const {
      return time != other.time ? time > other.time : number < other.number;
    }
  };
  struct LeavesInTime {
    LeafPair leaves;
    PartOfStep part;
    float until;
  };
  void wait(double time, const NodePair& nodes);
  /// The two leaves whose elements may come near first. They wait again for the time after the part.
  std::optional<LeavesInTime> next_leaves(const ObjectPairView& pair, TraversalStats& stats);

  /// Passes on pairs of elements in about the order of the times at which they may come near, so that
  /// `latest` decreases soon.
  template <class FindPairs>
  void find_in_time(const ObjectPairView& pair, NodePair root, TraversalStats& stats,
                    const FindPairs& find_pairs) {
    PartOfStep part;  // a little larger than those of the leaves, so that many have the same boxes
    part.separation = -1;
    until_ = 0;
    waiting_.clear();
    wait(0, root);
    for (int count = 1; const auto next = next_leaves(pair, stats); ++count) {
      const PartOfStep& own = next->part;
      const bool is_same_time = own.latest == part.latest && own.at_start == part.at_start;
      if (!is_same_time || !(own.separation <= part.separation) ||
          (own.separation < 0.5f * part.separation && !(part.separation < own.size / 64))) {
        is_same_time ? element_boxes_->clear_b() : element_boxes_->clear();
        part = own;
        if (pair.kept_share > 0) part.separation *= 1.125f;
      }
      until_ = std::max(until_, next->until);
      find_pairs({&next->leaves, 1}, part);
      constexpr int few = 8;  // so that they see a time that has decreased
      if (count % few != 0 && !(next->until < pair.latest->load(std::memory_order_relaxed))) continue;
      element_pairs_.flush();
      until_ = 0;
    }
  }

  void expand_batch(const ObjectPairView& pair, TraversalStats& stats);

  /// Calls `on_leaves` with batches of the leaf pairs below `root`.
  template <class OnLeaves>
  void descend(const ObjectPairView& pair, NodePair root, TraversalStats& stats, OnLeaves&& on_leaves) {
    if (pair.a.nodes.empty() || pair.b.nodes.empty()) return;
    stack_.assign(1, root);
    leaf_pairs_.clear();
    while (!stack_.empty() && !stop_.stop_requested()) {
      expand_batch(pair, stats);
      if (leaf_pairs_.size() < leaf_batch && !stack_.empty()) continue;
      on_leaves(std::span<const LeafPair>(leaf_pairs_));
      leaf_pairs_.clear();
    }
  }

  template <class Sink>
  void test_leaves(const ObjectPairView& pair, std::span<const LeafPair> leaves, TraversalStats& stats,
                   Sink&& sink) {
    constexpr std::size_t step = 32;
    const LeafArrays a{pair.a.arrays, pair.a.boxes, pair.a.leaf_vertices},
        b{pair.b.arrays, pair.b.boxes, pair.b.leaf_vertices};
    for (std::size_t i = 0; i < leaves.size(); i += step) {
      const auto part = leaves.subspan(i, std::min(step, leaves.size() - i));
      const std::uint64_t tests =
          find_triangle_box_pairs(part, a, b, pair.placement, pair.same_object, leaf_boxes_, candidates_);
      // The descent of Figure 4 ends at two leaves.
      if (pair.a.descent == Descent::both_sides) stats.volumes_tested += tests;
      if (candidates_.size() >= candidate_batch || i + step >= leaves.size()) {
        stats.candidate_pairs += candidates_.size();
        if (candidates_.size() > 0) sink(candidates_.pairs());
        candidates_.clear();
      }
    }
  }

  StopSignal stop_;
  std::vector<NodePair> stack_;
  std::vector<Waiting> waiting_;  // a heap
  std::uint32_t waited_ = 0;
  float until_ = 1;
  std::array<std::uint64_t, node_batch> masks_;
  std::array<NodePair, node_batch> batch_;
  std::vector<LeafPair> leaf_pairs_;
  LeafBoxCache leaf_boxes_;
  TrianglePairList candidates_;
  std::unique_ptr<MovingBoxCache> element_boxes_;  // made by the first `find_element_pairs`
  ElementPairBatches element_pairs_;
};

}  // namespace supple
