#pragma once

#include <cstdint>
#include <span>

#include "octree/octree_node.hpp"

namespace supple {

/// A refitted octree: its nodes and the boxes of their lanes.
struct TreeBoxes {
  std::span<const OctreeNode> nodes;
  const AabbLanes* boxes = nullptr;
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

/// Sets area and cost of all nodes, but the area of the root. Chooses the widest instruction
/// set at run time; the costs are equal on all.
void add_up_costs(const TreeBoxes& tree, NodeCost* costs);

}  // namespace supple
