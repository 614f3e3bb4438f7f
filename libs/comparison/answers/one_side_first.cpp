#include <cstdint>

#include "comparison/methods.hpp"
#include "geometry/aabb.hpp"

namespace supple {
namespace {

std::uint8_t child_bit(int child) {
  return static_cast<std::uint8_t>(1u << child);
}

/// Whether a child of object a overlaps a child of object b, by boxes or spheres. The comparisons are those
/// of `test_children`.
bool children_overlap(const ObjectPairView& pair, std::uint32_t node_a, int child_a, std::uint32_t node_b,
                      int child_b) {
  if (pair.a.volumes != nullptr) {
    const NodePair nodes{node_a, node_b, child_bit(child_a), child_bit(child_b)};
    std::uint64_t mask = ~std::uint64_t{0};
    pair.a.volumes->clear_apart({&nodes, 1}, *pair.b.volumes, pair.placement, &mask);
    return (mask >> (node_width * child_a + child_b) & 1) != 0;
  }
  return overlap(child_box(pair.a.boxes[node_a], child_a),
                 placed(child_box(pair.b.boxes[node_b], child_b), pair.placement));
}

/// The same for a child of object a and a whole node of object b.
bool child_overlaps_node(const ObjectPairView& pair, std::uint32_t node_a, int child_a,
                         std::uint32_t node_b) {
  const OctreeNode& node = pair.b.nodes[node_b];
  if (node_b != 0) return children_overlap(pair, node_a, child_a, node.parent, node.index_in_parent);
  if (pair.a.volumes != nullptr) return children_overlap(pair, node_a, child_a, pair.b.volumes->object(), 0);
  return overlap(child_box(pair.a.boxes[node_a], child_a), placed(pair.b.box, pair.placement));
}

}  // namespace

/// One pair of nodes in the order of the paper's Figure 4. A node that is restricted to one child, or has
/// one, stands for this leaf, which has no children. Two leaves are no step of Figure 4, so their test is not
/// counted: with several threads, it repeats the one that found them.
std::uint64_t mask_one_side_first(const ObjectPairView& pair, const NodePair& nodes, std::uint64_t& tests) {
  const std::uint32_t children_a = nodes.children_a & pair.a.nodes[nodes.a].child_mask(),
                      children_b = nodes.children_b & pair.b.nodes[nodes.b].child_mask();
  const bool is_leaf_a = bit_count(children_a) == 1, is_leaf_b = bit_count(children_b) == 1;
  std::uint64_t mask = 0;
  for (int i = 0; i < node_width; ++i) {
    if ((children_a >> i & 1) == 0) continue;
    if (!is_leaf_a && !is_leaf_b) {
      ++tests;
      if (!child_overlaps_node(pair, nodes.a, i, nodes.b)) continue;
    }
    for (int j = 0; j < node_width; ++j) {
      if ((children_b >> j & 1) == 0) continue;
      tests += is_leaf_a && is_leaf_b ? 0 : 1;
      mask |= std::uint64_t{children_overlap(pair, nodes.a, i, nodes.b, j)} << (node_width * i + j);
    }
  }
  return mask;
}

}  // namespace supple
