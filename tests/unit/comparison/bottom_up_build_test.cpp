#include "comparison/methods.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "support/soups.hpp"
#include "support/topologies.hpp"

namespace supple::bottom_up_build_test {

OctreeTopology built(const TriangleMesh& mesh, const ObjectOctreeOptions& options = {}) {
  return build_bottom_up_octree(mesh.positions, mesh.triangles, centers_of(mesh), options);
}

double mean_leaf_size(const OctreeTopology& topology) {
  return static_cast<double>(topology.order.size()) / static_cast<double>(leaves_of(topology).size());
}

/// Triangles in a row whose distances grow: the nearest neighbour of each is the one before it.
TriangleMesh graded_row(std::uint32_t count) {
  TriangleMesh mesh;
  double x = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    x += 1 + t;
    for (const Vec3d& corner : {Vec3d{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}})
      mesh.positions.push_back(corner + Vec3d{x, 0, 0});
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

TEST(BottomUpBuild, IsSoundForAnySizesOptionsAndPositions) {
  RandomNumbers random(1);
  for (std::uint32_t count = 0; count < 700; count += 1 + count / 3) {
    for (std::uint32_t way = 0; way < hard_ways; ++way) {
      for (const std::uint32_t arity : {2u, 4u, 8u}) {
        const TriangleMesh mesh = count % 2 == 1
                                      ? random_soup(count, 1, 0.1, count)
                                      : crumpled_sheet(count == 0 ? 0 : 1 + count / 8, 4, 0.1, count);
        const ObjectOctreeOptions options{.max_level = random.below(4) == 0 ? random.below(4) : 16,
                                          .leaf_size = 1 + random.below(random.below(2) == 0 ? 4 : 70),
                                          .arity = arity,
                                          .build = ObjectOctreeBuild::bottom_up};
        SCOPED_TRACE(std::to_string(count) + " way " + std::to_string(way) + " arity " +
                     std::to_string(arity) + " leaf size " + std::to_string(options.leaf_size) + " level " +
                     std::to_string(options.max_level));
        expect_sound(built(hard_positions(mesh, way, random), options), mesh.triangles.size(), options,
                     deepest_level(options));
        if (HasFailure()) return;
      }
    }
  }
}

TEST(BottomUpBuild, FillsLeavesAndNodes) {
  for (const std::uint32_t frequency : {7u, 13u, 20u, 30u, 44u, 59u}) {
    const OctreeTopology topology = built(make_icosphere(frequency));
    EXPECT_GE(mean_leaf_size(topology), 32) << frequency;
    std::size_t children = 0;
    for (const OctreeNode& node : topology.nodes) children += node.child_count;
    EXPECT_GE(static_cast<double>(children), 4.5 * static_cast<double>(topology.nodes.size())) << frequency;
    EXPECT_LE(topology.level_begin.size() - 1, 5u) << frequency;
  }
}

TEST(BottomUpBuild, MergesNeighboursFirst) {
  // Eight far clusters of eight triangles. The clusters become the leaves, whatever the order of triangles.
  RandomNumbers random(5);
  TriangleMesh mesh;
  std::vector<std::uint32_t> cluster_of;
  for (std::uint32_t t = 0; t < 64; ++t) {
    const std::uint32_t cluster = (t * 37 + 11) % 8;
    const Vec3d middle{100.0 * (cluster & 1), 100.0 * (cluster >> 1 & 1), 100.0 * (cluster >> 2)};
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(middle + random.vector(1));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    cluster_of.push_back(cluster);
  }
  const OctreeTopology topology = built(mesh, {.leaf_size = 8});
  EXPECT_EQ(topology.nodes.size(), 1u);
  const auto leaves = leaves_of(topology);
  ASSERT_EQ(leaves.size(), 8u);
  for (const auto& leaf : leaves) {
    ASSERT_EQ(leaf.size(), 8u);
    for (const std::uint32_t t : leaf) EXPECT_EQ(cluster_of[t], cluster_of[leaf.front()]);
  }
}

TEST(BottomUpBuild, TakesFewRoundsForHardRows) {
  // These take minutes when a round merges only the pairs that chose each other.
  for (const TriangleMesh& mesh : {graded_row(30'000), [] {
                                     TriangleMesh equal = graded_row(30'000);
                                     std::ranges::fill(equal.positions, Vec3d{1, 2, 3});
                                     return equal;
                                   }()}) {
    const OctreeTopology topology = built(mesh);
    EXPECT_GE(mean_leaf_size(topology), 32);
    EXPECT_LE(topology.level_begin.size() - 1, 6u);
  }
}

TEST(BottomUpBuild, SeparatesTheRestWhenOneVertexIsFarAway) {
  for (const double far : {1e10, 1e30, 1e300}) {
    for (const std::size_t at : {0u, 500u, 1000u, 1999u}) {
      TriangleMesh mesh = random_soup(2000, 1, 0.01, 4);
      mesh.positions[3 * at] = {far, far, -far};
      const std::vector<Vec3d> centers = centers_of(mesh);
      const auto leaves = leaves_of(built(mesh));
      std::size_t small = 0;
      for (const auto& leaf : leaves) {
        Vec3d low{1, 1, 1}, high{-1, -1, -1};
        for (const std::uint32_t t : leaf) {
          for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], centers[t][axis]);
            high[axis] = std::max(high[axis], centers[t][axis]);
          }
        }
        const Vec3d size = high - low;
        small += size.x * size.y * size.z < 1 ? 1 : 0;
      }
      EXPECT_GE(small + 1, leaves.size()) << far << ' ' << at;
    }
  }
}

TEST(BottomUpBuild, IsTheSameOnEveryMachine) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](std::uint64_t value) { hash = (hash ^ value) * 0x100000001b3u; };
  for (const char* model : {"pawn", "rabbit", "bike"}) {
    for (const std::uint32_t arity : {2u, 8u}) {
      const OctreeTopology topology = built(make_model(model), {.leaf_size = 16, .arity = arity});
      for (const std::uint32_t triangle : topology.order) add(triangle);
      for (const OctreeNode& node : topology.nodes) {
        add(node.first_child);
        for (const std::uint32_t first : node.first_triangle) add(first);
      }
    }
  }
  EXPECT_EQ(hash, 1104377019248800686u);
}

}  // namespace supple::bottom_up_build_test
