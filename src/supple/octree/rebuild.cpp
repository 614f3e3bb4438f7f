#include "octree/rebuild.hpp"

#include <cstddef>
#include <utility>

namespace supple {
namespace {

constexpr std::uint32_t kept = no_node;

/// Copies nodes, parents before children.
class Relinking {
 public:
  Relinking(std::span<const OctreeNode> nodes, std::span<const NewSubtree> subtrees)
      : nodes_(nodes), subtrees_(subtrees), new_subtree_(nodes.size(), kept) {
    for (std::uint32_t i = 0; i < subtrees.size(); ++i) new_subtree_[subtrees[i].node] = i;
  }

  RelinkedNodes run() {
    push(source_of(0), 0, 0, 0);
    for (std::uint32_t n = 0; n < result_.nodes.size(); ++n) add_children(n);
    result_.level_begin.push_back(static_cast<std::uint32_t>(result_.nodes.size()));
    return std::move(result_);
  }

 private:
  /// Where a node comes from: a node of a new subtree, or of the old tree.
  struct Source {
    std::uint32_t subtree, node;
  };

  Source source_of(std::uint32_t old_node) const {
    const std::uint32_t subtree = new_subtree_[old_node];
    return {subtree, subtree == kept ? old_node : 0};
  }

  const OctreeNode& original(Source source) const {
    return source.subtree == kept ? nodes_[source.node]
                                  : subtrees_[source.subtree].topology.nodes[source.node];
  }

  void add_children(std::uint32_t n) {
    const Source source = sources_[n];
    const OctreeNode& before = original(source);
    result_.nodes[n].first_child = static_cast<std::uint32_t>(result_.nodes.size());
    result_.nodes[n].inner_mask = 0;
    for (int lane = 0; lane < before.lane_count; ++lane) {
      if (!before.is_inner(lane)) continue;
      const std::uint32_t child = before.child(lane);
      const Source below = source.subtree == kept ? source_of(child) : Source{source.subtree, child};
      if (original(below).lane_count == 1) continue;
      OctreeNode& node = result_.nodes[n];
      node.inner_mask = static_cast<std::uint8_t>(node.inner_mask | 1u << lane);
      push(below, n, lane, node.level + 1);
    }
  }

  void push(Source source, std::uint32_t parent, int parent_lane, int level) {
    OctreeNode node = original(source);
    std::uint32_t old_node = source.node;
    if (source.subtree != kept) {
      const std::uint32_t replaced = subtrees_[source.subtree].node;
      for (std::uint32_t& triangle : node.first_triangle) triangle += nodes_[replaced].first_triangle[0];
      old_node = source.node == 0 ? replaced : no_node;
    }
    node.parent = parent;
    node.parent_lane = static_cast<std::uint8_t>(parent_lane);
    node.level = static_cast<std::uint8_t>(level);
    if (result_.level_begin.size() == static_cast<std::size_t>(level)) {
      result_.level_begin.push_back(static_cast<std::uint32_t>(result_.nodes.size()));
    }
    result_.nodes.push_back(node);
    result_.old_nodes.push_back(old_node);
    sources_.push_back(source);
  }

  std::span<const OctreeNode> nodes_;
  std::span<const NewSubtree> subtrees_;
  std::vector<std::uint32_t> new_subtree_;  // that takes the place of each node
  std::vector<Source> sources_;             // of each node of the result
  RelinkedNodes result_;
};

}  // namespace

RelinkedNodes relink(std::span<const OctreeNode> nodes, std::span<const NewSubtree> subtrees) {
  return Relinking(nodes, subtrees).run();
}

}  // namespace supple
