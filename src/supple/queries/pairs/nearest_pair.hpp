#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contact/distance/distance_kernels.hpp"
#include "contact/distance/recent_elements.hpp"
#include "core/stop_signal.hpp"
#include "narrow_phase/query_kernels.hpp"
#include "narrow_phase/recent_leaf_boxes.hpp"
#include "queries/object_queries.hpp"
#include "queries/pairs/nearest_bound.hpp"
#include "queries/pairs/proximity_pair.hpp"

namespace supple {

/// Finds the nearest features of two objects by descending both octrees at once, nearest pairs of children
/// first. Holds the memory of one worker. Does not use the traversal of `narrow_phase`, which visits pairs in
/// any order: each distance that this search finds discards pairs on its stack, so the order decides its
/// cost.
class NearestPairSearch {
 public:
  /// Whether any two triangles of the objects intersect.
  bool any_contact(const QueriedObject& a, const QueriedObject& b, const StopSignal& stop);

  /// The nearest features; nothing when they are farther apart than `max_distance` or an object has no finite
  /// triangle. Of several pairs at the same distance, the first one in the order of proximity pairs. When the
  /// surfaces intersect: the first extreme point of their first contact, at distance 0. `guess` are triangles
  /// that may be near, in octree order. After a request to stop, the result is of no use.
  std::optional<ProximityPair> nearest(const QueriedObject& a, const QueriedObject& b, double max_distance,
                                       std::optional<TrianglePair> guess, const StopSignal& stop);
  /// Triangles with the features of the last result, in octree order.
  TrianglePair triangles() const { return triangles_; }
  /// The work of the last search: pairs of triangles and of elements that it decided.
  std::uint64_t decided_triangles() const { return decided_triangles_; }
  std::uint64_t decided_elements() const { return decided_elements_; }

 private:
  /// Children of a node of a and of a node of b.
  struct Entry {
    float square = 0, depth = 0;
    std::uint32_t node_a = 0, node_b = 0;
    int child_a = 0, child_b = 0;
    std::uint64_t version = 0;  // of the bound that did not exclude it
  };
  /// Triangles of a block of a leaf, as `bound_` sees all of them.
  struct BlockSummary {
    std::uint32_t begin = 0;
    std::uint64_t triangles = 0, version = 0;
    double least = 0;     // depth
    TriangleLevel level;  // the least

    bool is_known(std::uint32_t begins, std::uint64_t chosen, std::uint64_t current) const {
      return begin == begins && version == current && (chosen & ~triangles) == 0;
    }
  };
  struct BlockDepths {
    BlockSummary all;
    std::array<TriangleDepths, leaf_block> depths;
    std::array<double, leaf_block> least;
  };
  /// A vertex and a face, or two edges.
  struct ElementCandidate {
    PairElement first, second;
    PairOrder order = PairOrder::given;
    TrianglePair triangles;
    bool is_not_nearer = false;  ///< than the nearest features, now and later
  };
  struct Candidates {
    PointsBlock block;
    std::array<ElementCandidate, PointsBlock::capacity> candidates;
    std::size_t count = 0;
  };
  enum class Search : std::uint8_t { any_contact, nearest };

  void start(const QueriedObject& a, const QueriedObject& b, Search search, double max_distance,
             const StopSignal& stop);
  void descend();
  bool are_apart(const Entry& entry) const;
  void expand(std::uint32_t node_a, int first_a, int end_a, std::uint32_t node_b, int first_b, int end_b);
  void test_leaves(const Entry& leaves);
  std::uint64_t within_limit(const QueriedObject& object, std::uint32_t begin, std::uint64_t triangles,
                             const QueryBox& box) const;
  void test_blocks(const LeafBoxes& boxes_a, std::uint64_t near_a, std::uint32_t begin_a,
                   const LeafBoxes& boxes_b, std::uint64_t near_b, std::uint32_t begin_b);
  bool are_excluded(const BlockSummary& a, const BlockSummary& b) const;
  bool are_known_excluded(std::uint32_t begin_a, std::uint64_t near_a, std::uint32_t begin_b,
                          std::uint64_t near_b) const;
  void keep_near(std::uint32_t begin_a, std::uint64_t& near_a, std::uint32_t begin_b,
                 std::uint64_t& near_b) const;
  void find_depths(NearestBound::Side side, std::uint32_t begin, std::uint64_t triangles, BlockDepths& block);
  void squared_distances_of(const Aabb& box, const QueryBox& placed, std::uint32_t node_b, int first, int end,
                            std::span<const QueryBox> placed_b, std::array<float, node_width>& squares) const;
  void decide(TrianglePair triangles);
  void decide_elements(TrianglePair triangles, const TrianglePoints& a, const TrianglePoints& b);
  void add(const ElementCandidate& candidate);
  void consider_all();
  void consider(Candidates& list);
  void consider(const ElementCandidate& candidate);
  void guess_by_projection();
  ProximityPair contact_pair() const;
  void set_limit(double limit);
  bool is_done() const { return (search_ == Search::any_contact && intersects_) || stop_.stop_requested(); }
  /// A box of a as b's boxes see it, and the other way round.
  Aabb seen_by_b(const Aabb& box) const { return seen(box, 1); }
  Aabb seen_by_a(const Aabb& box) const { return seen(box, -1); }
  Aabb seen(const Aabb& box, double direction) const;

  const QueriedObject* a_ = nullptr;
  const QueriedObject* b_ = nullptr;
  Search search_ = Search::nearest;
  StopSignal stop_;
  Vec3d offset_, slop_;  // from a to b
  double limit_ = 0;
  float squared_limit_ = 0;
  bool intersects_ = false, used_exact_ = false;
  std::uint64_t decided_triangles_ = 0, decided_elements_ = 0;
  TrianglePair triangles_;
  std::optional<ProximityPair> best_;
  ElementPoints best_elements_;
  NearestBound bound_;
  BlockDepths block_a_, block_b_;
  std::array<std::vector<BlockSummary>, 2> excluded_;  // of blocks at one place, by an eighth of their begin
  std::vector<Entry> stack_;
  RecentElements<bool> farther_;  // elements that are farther apart than the nearest
  Candidates vertices_and_faces_, edges_;
  RecentLeaves<LeafBoxes> recent_;
  ObjectQueries queries_;
};

}  // namespace supple
