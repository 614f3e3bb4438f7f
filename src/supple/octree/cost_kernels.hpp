#pragma once

#include <cstdint>
#include <span>

#include "octree/octree_node.hpp"

namespace supple {

/// A refitted octree: its nodes and the boxes of their lanes. Lanes of at most `leaf_limit` triangles are
/// leaves whatever is below them, and nodes below have no boxes.
struct TreeBoxes {
  std::span<const OctreeNode> nodes;
  const AabbLanes* boxes = nullptr;
  std::uint32_t leaf_limit = 0;

  bool is_leaf(const OctreeNode& node, int lane) const {
    return !node.is_inner(lane) || node.size(lane) <= leaf_limit;
  }
  bool has_boxes(std::uint32_t n) const { return n == 0 || nodes[n].size() > leaf_limit; }
};

/// Of a node, in surfaces; what is kept of it between measurements is its reference.
struct NodeCost {
  double reference = 0;   ///< cost over area when it was built
  double area = 0;        ///< half the surface of its box
  double cost = 0;        ///< of all lanes below: half their surfaces times what a visit costs
  double net_saving = 0;  ///< by the best choice of what to build anew of it
};

/// A leaf costs a visit, as a node does, and this for each of its triangles.
constexpr double visits_a_triangle = 0.125;

/// Sets area and cost of all nodes that have boxes, but the area of the root. Chooses the widest instruction
/// set at run time; the costs are equal on all.
void add_up_costs(const TreeBoxes& tree, NodeCost* costs);

}  // namespace supple
