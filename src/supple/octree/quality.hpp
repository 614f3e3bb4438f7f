#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/cost_kernels.hpp"

namespace supple {

/// How well the boxes of an octree tell its triangles apart, compared with those it was built with.
///
/// A box of surface S within a region of surface R is met by a share S / R of the queries that meet the
/// region. So what is below a node costs each query that meets the node, on average, the surfaces of all
/// lanes below it, each times the cost of a visit, over the node's own: the surface-area heuristic.
/// (Goldsmith and Salmon, "Automatic creation of object hierarchies for ray tracing", 1987.) It is the same
/// for an object that is moved or scaled. Each node keeps the cost that it had when built, its reference;
/// what it costs beyond that is taken for what building it anew would save.
///
/// Sums are of doubles in one order: the same decisions everywhere. Memory: 32 bytes a node.
class TreeQuality {
 public:
  /// Call after the tree was built from these positions: the references become the present costs. O(nodes),
  /// as are all functions.
  void set_references(const TreeBoxes& tree);
  /// Call after subtrees were rebuilt and boxes refitted. The present costs become the references of the new
  /// nodes; the difference to the former references is added to the nodes above.
  void update_references(const TreeBoxes& tree, std::span<const std::uint32_t> old_nodes);
  /// Allocates memory only when the number of nodes changed. The result is unknown for a tree without a
  /// surface or too large for double.
  void measure(const TreeBoxes& tree);

  /// The visits of a query that meets the object, at the last measurement; 0 when unknown.
  double cost() const { return is_known() ? nodes_[0].cost / nodes_[0].area : 0; }
  /// The cost relative to the reference: 1 after a build, 2 when queries cost twice as much.
  double degradation() const { return is_known() ? nodes_[0].cost / reference_cost() : 1; }

  /// Nodes that are worth building anew, with all below them: the choice that saves most, where a saving has
  /// to be `least_saving` of the subtree's share of the tree at least. None is below another; ascending.
  std::span<const std::uint32_t> degraded() const { return degraded_; }
  /// What these save, over the reference cost of the tree; and their share of the triangles.
  double saving() const { return saving_; }
  double share() const { return share_; }
  /// What they cost, in the units of `cost`.
  double degraded_cost() const { return degraded_cost_; }

  std::size_t bytes() const {
    return nodes_.capacity() * sizeof(NodeCost) + degraded_.capacity() * sizeof(std::uint32_t);
  }

  static constexpr double least_saving = 0.25;

 private:
  bool is_known() const;
  double reference_cost() const { return nodes_[0].reference * nodes_[0].area; }
  void set_costs(const TreeBoxes& tree);
  void clear_choice();
  double net_saving(const TreeBoxes& tree, std::uint32_t n) const;
  void choose(const TreeBoxes& tree);

  std::vector<NodeCost> nodes_;
  std::vector<std::uint32_t> degraded_;
  double saving_ = 0, share_ = 0, degraded_cost_ = 0;
};

}  // namespace supple
