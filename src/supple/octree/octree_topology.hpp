#pragma once

#include <algorithm>
#include <array>
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
  /// In a regular octree, the number of the octant of child i of node n at 8 n + i (`OctreeCell::number`), or
  /// `no_number`.
  std::vector<std::uint64_t> numbers;
};

constexpr std::uint64_t no_number = std::numeric_limits<std::uint64_t>::max();

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

/// A range that becomes a node, and the ranges that become its children.
struct NodeDivision {
  TriangleRange range{};
  std::array<TriangleRange, node_width> children{};
  std::array<std::uint64_t, node_width> numbers{};  // of the octants of the children, in a regular octree
  std::uint32_t child_count = 0;

  void push_child(TriangleRange child, std::uint64_t number = 0) {
    numbers[child_count] = number;
    children[child_count++] = child;
  }
};

/// Makes all nodes from the root down, level by level. The splitter decides the order of the triangles:
/// - `should_split(range, level)` returns whether the range becomes a node, not a leaf. It may reorder the
///   range.
/// - `split(nodes, level)` gives each `NodeDivision` of the level two to eight children that cover its range.
///   It may reorder the ranges. A splitter that `has_numbers` also gives the numbers of the children.
/// - `finish(leaves)` may reorder the triangles of each leaf. It returns the triangles in their order.
template <class Splitter>
OctreeTopology build_octree(std::uint32_t triangle_count, Splitter splitter) {
  OctreeTopology topology;
  std::vector<NodeDivision> divisions;
  std::vector<TriangleRange> ranges, leaves;
  const auto push_node = [&](TriangleRange range, std::size_t parent, std::uint32_t index,
                             std::uint32_t level) {
    OctreeNode node{};
    node.parent = static_cast<std::uint32_t>(parent);
    node.index_in_parent = static_cast<std::uint8_t>(index);
    node.level = static_cast<std::uint8_t>(level);
    topology.nodes.push_back(node);
    ranges.push_back(range);
  };
  if (triangle_count > 0) push_node({0, triangle_count}, 0, 0, 0);
  for (std::uint32_t level = 0, begin = 0; begin < topology.nodes.size(); ++level) {
    const auto end = static_cast<std::uint32_t>(topology.nodes.size());
    topology.level_begin.push_back(begin);
    divisions.clear();
    for (std::uint32_t n = begin; n < end; ++n) divisions.push_back({.range = ranges[n]});
    if (level > 0 || splitter.should_split(divisions.front().range, 0)) {
      splitter.split(std::span(divisions), level);
    } else {
      divisions.front().push_child(divisions.front().range);  // a root with one leaf
    }
    for (std::uint32_t n = begin; n < end; ++n) {
      const NodeDivision& division = divisions[n - begin];
      OctreeNode node = topology.nodes[n];
      node.first_child = static_cast<std::uint32_t>(topology.nodes.size());
      node.child_count = static_cast<std::uint8_t>(division.child_count);
      for (std::uint32_t i = 0; i < division.child_count; ++i) {
        const TriangleRange child = division.children[i];
        node.first_triangle[i] = child.begin;
        if (division.child_count == 1 || !splitter.should_split(child, level + 1)) {
          leaves.push_back(child);
          continue;
        }
        node.inner_mask = static_cast<std::uint8_t>(node.inner_mask | 1u << i);
        push_node(child, n, i, level + 1);
      }
      std::fill(node.first_triangle + node.child_count, node.first_triangle + node_width + 1,
                division.range.end);
      topology.nodes[n] = node;
      if constexpr (requires { Splitter::has_numbers; })
        topology.numbers.insert(topology.numbers.end(), division.numbers.begin(), division.numbers.end());
    }
    begin = end;
  }
  topology.level_begin.push_back(static_cast<std::uint32_t>(topology.nodes.size()));
  topology.order = splitter.finish(std::span<const TriangleRange>(leaves));
  return topology;
}

/// Bounds of the centres of triangles, without those that are not finite. Centres are scaled down so that
/// differences of coordinates cannot overflow.
struct CenterBounds {
  static constexpr double scale = 0.25;
  static constexpr double inf = std::numeric_limits<double>::infinity();
  Vec3d lower{inf, inf, inf}, upper{-inf, -inf, -inf};

  void add(const Vec3d& center) {
    if (!is_finite(center)) return;
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], center[axis] * scale);
      upper[axis] = std::max(upper[axis], center[axis] * scale);
    }
  }
  /// Not positive when all centres are one point or none is finite.
  double longest_side() const { return std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z}); }
};

}  // namespace supple
