#include "experiments/studies/shape_pair.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace supple::experiments::colliding_children_test {

OctreeCell cell(std::uint32_t level, std::uint64_t number, bool is_leaf = false) {
  OctreeCell result;
  result.level = level;
  result.number = number;
  result.is_leaf = is_leaf;
  return result;
}

/// Quadtrees. Three children of root a collide with two of root b, one of which is a leaf; below, two
/// children of node 1 collide with the leaf that waits, and one child with one child of node 2.
TEST(CollidingChildren, AreCountedForEachSideOfAPair) {
  NodePairList list;
  list.nodes_a = {cell(0, 0),       cell(1, 1),       cell(1, 2, true),
                  cell(1, 4, true), cell(2, 5, true), cell(2, 8, true)};
  list.nodes_b = {cell(0, 0), cell(1, 2), cell(1, 3, true), cell(2, 9, true)};
  list.pairs = {{0, 0}, {1, 1}, {1, 2}, {2, 2}, {3, 2}, {4, 2}, {4, 3}, {5, 2}};
  list.level_begin = {0, 1, 5, 8};
  const CollidingChildren counted = colliding_children(list, 4);
  // Roots: 3 and 2. Nodes 1 and 2: 1 and 1. Node 1 and leaf 3: 2, and the leaf has no children.
  EXPECT_EQ(counted.nodes, 5u);
  EXPECT_EQ(counted.children, 9u);
  EXPECT_EQ(counted.most, 3u);
  EXPECT_EQ(counted.above, 1u);
}

TEST(CollidingChildren, AreNoneWithoutLevelsBelowTheRoot) {
  NodePairList list;
  EXPECT_EQ(colliding_children(list, 8).nodes, 0u);
  list.nodes_a = list.nodes_b = {cell(0, 0, true)};
  list.pairs = {{0, 0}};
  list.level_begin = {0, 1};
  EXPECT_EQ(colliding_children(list, 8).nodes, 0u);
}

}  // namespace supple::experiments::colliding_children_test
