#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "octree/octree_topology.hpp"
#include "supple/mesh.hpp"
#include "support/random.hpp"

// For tests of the methods that build octrees.

namespace supple {

inline std::vector<Vec3d> centers_of(const TriangleMesh& mesh) {
  std::vector<Vec3d> centers;
  for (const Triangle& t : mesh.triangles) {
    centers.push_back((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1.0 / 3));
  }
  return centers;
}

/// The triangles of each leaf, in the order of the tree.
inline std::vector<std::vector<std::uint32_t>> leaves_of(const OctreeTopology& topology) {
  std::vector<std::vector<std::uint32_t>> leaves;
  for (const OctreeNode& node : topology.nodes) {
    for (int child = 0; child < node.child_count; ++child) {
      if (node.is_inner(child)) continue;
      leaves.emplace_back(topology.order.begin() + node.first_triangle[child],
                          topology.order.begin() + node.first_triangle[child + 1]);
    }
  }
  return leaves;
}

/// Checks that each triangle is in exactly one leaf and that the links between nodes agree.
/// `deepest` is the deepest level that the nodes may have.
inline void expect_sound(const OctreeTopology& topology, std::size_t count,
                         const ObjectOctreeOptions& options, std::uint32_t deepest) {
  std::vector<std::uint32_t> sorted = topology.order, all(count);
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0u);
  ASSERT_EQ(sorted, all);
  ASSERT_EQ(topology.level_begin.back(), topology.nodes.size());
  std::size_t in_leaves = 0;
  for (std::uint32_t n = 0; n < topology.nodes.size(); ++n) {
    const OctreeNode& node = topology.nodes[n];
    ASSERT_GE(n, topology.level_begin[node.level]);
    ASSERT_LT(n, topology.level_begin[node.level + 1u]);
    ASSERT_TRUE(node.child_count >= 2 || topology.nodes.size() == 1);
    ASSERT_LE(node.child_count, options.arity);
    for (int child = 0; child < node.child_count; ++child) {
      ASSERT_GT(node.size(child), 0u);
      if (!node.is_inner(child)) {
        in_leaves += node.size(child);
        if (node.level + 1u < deepest) {
          ASSERT_LE(node.size(child), options.leaf_size);
        }
        continue;
      }
      const OctreeNode& below = topology.nodes[node.child_node(child)];
      ASSERT_LT(below.level, deepest);
      ASSERT_EQ(below.parent, n);
      ASSERT_EQ(below.index_in_parent, child);
      ASSERT_EQ(below.first_triangle[0], node.first_triangle[child]);
      ASSERT_EQ(below.first_triangle[node_width], node.first_triangle[child + 1]);
    }
  }
  ASSERT_EQ(in_leaves, count);
}

constexpr std::uint32_t hard_ways = 10;

/// Degenerate positions, selected by a number below `hard_ways`.
inline TriangleMesh hard_positions(TriangleMesh mesh, std::uint32_t way, RandomNumbers& random) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (Vec3d& p : mesh.positions) {
    switch (way) {
      case 0:
        p = {1, 2, 3};
        break;
      case 1:
        p = p * 1e-310;
        break;
      case 2:
        p = p * 1e305;
        break;
      case 3:
        p = {static_cast<double>(random.below(2)), 0, 0};
        break;
      case 4:
        p = random.below(3) == 0 ? Vec3d{inf, 0, 0} : p;
        break;
      case 5:
        p = random.below(40) == 0 ? p * 1e30 : p;
        break;
      case 6:
        p = p + Vec3d{1e12, -1e12, 0};
        break;
      case 7:
        p = p * std::exp(700 * random.uniform(-1, 1));
        break;
      default:
        p = {p.x, 0, 0};
    }
  }
  return mesh;
}

}  // namespace supple
