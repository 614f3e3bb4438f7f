#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/vector.hpp"
#include "octree/octree_node.hpp"
#include "supple/options.hpp"
#include "supple/types.hpp"

namespace supple {

/// The nodes of an octree and the order of its triangles.
struct OctreeTopology {
  std::vector<OctreeNode> nodes;           ///< level by level; empty when there are no triangles
  std::vector<std::uint32_t> order;        ///< triangle at each place of the octree's order
  std::vector<std::uint32_t> level_begin;  ///< first node of each level, then the number of nodes
};

constexpr int bits_per_level(std::uint32_t arity) {
  return arity == 8 ? 3 : arity == 4 ? 2 : 1;
}

/// The deepest level of nodes of this arity. Options count levels of eight children.
constexpr std::uint32_t deepest_level(const ObjectOctreeOptions& options) {
  return options.max_level * 3 / static_cast<std::uint32_t>(bits_per_level(options.arity));
}

/// Triangles in the octree's order that become a node or a leaf.
struct TriangleRange {
  std::uint32_t begin, end;

  std::uint32_t size() const { return end - begin; }
};

/// Makes all nodes from the root down. The splitter decides the order of the triangles:
/// - `items()` returns the triangles in their order, as items with a member `triangle`.
/// - `should_split(range, level)` returns whether the range becomes a node, not a leaf. It may reorder the
///   range.
/// - `split(range, level, children)` appends two to eight ranges that cover the range. It may reorder it.
/// - `finish_leaf(range)` may reorder the triangles of a leaf.
template <class Splitter>
OctreeTopology build_octree(Splitter splitter) {
  OctreeTopology topology;
  std::vector<TriangleRange> ranges, children;
  const auto push_node = [&](TriangleRange range, std::size_t parent, std::uint32_t index,
                             std::uint32_t level) {
    if (topology.level_begin.size() == level) {
      topology.level_begin.push_back(static_cast<std::uint32_t>(topology.nodes.size()));
    }
    OctreeNode node{};
    node.parent = static_cast<std::uint32_t>(parent);
    node.index_in_parent = static_cast<std::uint8_t>(index);
    node.level = static_cast<std::uint8_t>(level);
    topology.nodes.push_back(node);
    ranges.push_back(range);
  };
  const auto triangle_count = static_cast<std::uint32_t>(splitter.items().size());
  if (triangle_count > 0) push_node({0, triangle_count}, 0, 0, 0);
  for (std::size_t n = 0; n < topology.nodes.size(); ++n) {
    const TriangleRange range = ranges[n];
    OctreeNode node = topology.nodes[n];
    node.first_child = static_cast<std::uint32_t>(topology.nodes.size());
    children.clear();
    if (splitter.should_split(range, node.level)) {
      splitter.split(range, node.level, children);
    } else {
      children.push_back(range);  // a root with one leaf
    }
    for (const TriangleRange& child : children) {
      const std::uint32_t i = node.child_count++;
      node.first_triangle[i] = child.begin;
      if (children.size() == 1 || !splitter.should_split(child, node.level + 1u)) {
        splitter.finish_leaf(child);
        continue;
      }
      node.inner_mask = static_cast<std::uint8_t>(node.inner_mask | 1u << i);
      push_node(child, n, i, node.level + 1u);
    }
    std::fill(node.first_triangle + node.child_count, node.first_triangle + node_width + 1, range.end);
    topology.nodes[n] = node;
  }
  topology.level_begin.push_back(static_cast<std::uint32_t>(topology.nodes.size()));
  topology.order.reserve(triangle_count);
  for (const auto& item : splitter.items()) topology.order.push_back(item.triangle);
  return topology;
}

/// Bounds of the centres of triangles, without those that are not finite. Centres are scaled down so that
/// differences of coordinates cannot overflow.
struct CenterBounds {
  static constexpr double scale = 0.25;
  static constexpr double inf = std::numeric_limits<double>::infinity();
  Vec3d lower{inf, inf, inf}, upper{-inf, -inf, -inf};

  /// The centre of an item is `centers[item.triangle]`.
  template <class Item>
  CenterBounds(std::span<Item> items, std::span<const Vec3d> centers) {
    for (const Item& item : items) {
      const Vec3d& c = centers[item.triangle];
      if (!is_finite(c)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], c[axis] * scale);
        upper[axis] = std::max(upper[axis], c[axis] * scale);
      }
    }
  }
  /// Not positive when all centres are one point or none is finite.
  double longest_side() const { return std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z}); }
};

}  // namespace supple
