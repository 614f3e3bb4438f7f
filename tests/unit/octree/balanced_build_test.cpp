#include "octree/balanced_build.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "support/soups.hpp"

namespace supple {
namespace {

std::vector<Vec3d> centers_of(const TriangleMesh& mesh) {
  std::vector<Vec3d> centers;
  for (const Triangle& t : mesh.triangles) {
    centers.push_back((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1.0 / 3));
  }
  return centers;
}

OctreeTopology built(const TriangleMesh& mesh, const ObjectOctreeOptions& options = {}) {
  return build_balanced_octree(centers_of(mesh), mesh.triangles, options);
}

/// The triangles of each leaf, in the order of the tree.
std::vector<std::vector<std::uint32_t>> leaves_of(const OctreeTopology& topology) {
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
void expect_sound(const OctreeTopology& topology, std::size_t count, const ObjectOctreeOptions& options) {
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
    for (int child = 0; child < node.child_count; ++child) {
      ASSERT_GT(node.size(child), 0u);
      if (!node.is_inner(child)) {
        in_leaves += node.size(child);
        if (node.level + 1u < options.max_level) {
          ASSERT_LE(node.size(child), options.leaf_size);
        }
        continue;
      }
      const OctreeNode& below = topology.nodes[node.child_node(child)];
      ASSERT_LT(below.level, options.max_level);
      ASSERT_EQ(below.parent, n);
      ASSERT_EQ(below.index_in_parent, child);
      ASSERT_EQ(below.first_triangle[0], node.first_triangle[child]);
      ASSERT_EQ(below.first_triangle[node_width], node.first_triangle[child + 1]);
    }
  }
  ASSERT_EQ(in_leaves, count);
}

/// Degenerate positions, selected by number.
TriangleMesh hard(TriangleMesh mesh, std::uint32_t way, RandomNumbers& random) {
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

TEST(BalancedBuild, IsSoundForAnySizesOptionsAndPositions) {
  RandomNumbers random(1);
  for (std::uint32_t count = 0; count < 700; count += 1 + count / 3) {
    for (std::uint32_t way = 0; way < 10; ++way) {
      for (const bool in_parts : {false, true}) {
        const TriangleMesh mesh = in_parts ? random_soup(count, 1, 0.1, count)
                                           : crumpled_sheet(count == 0 ? 0 : 1 + count / 8, 4, 0.1, count);
        const ObjectOctreeOptions options{.max_level = random.below(4) == 0 ? random.below(4) : 16,
                                          .leaf_size = 1 + random.below(random.below(2) == 0 ? 4 : 70)};
        SCOPED_TRACE(std::to_string(count) + " way " + std::to_string(way) + " leaf size " +
                     std::to_string(options.leaf_size) + " level " + std::to_string(options.max_level));
        expect_sound(built(hard(mesh, way, random), options), mesh.triangles.size(), options);
        if (HasFailure()) return;
      }
    }
  }
}

TEST(BalancedBuild, FillsLeavesAndNodesEvenly) {
  for (const std::uint32_t frequency : {7u, 13u, 20u, 30u, 44u, 59u}) {
    const TriangleMesh sphere = make_icosphere(frequency);
    const OctreeTopology topology = built(sphere);
    std::size_t least = sphere.triangles.size(), most = 0;
    const auto leaves = leaves_of(topology);
    for (const auto& leaf : leaves) {
      least = std::min(least, leaf.size());
      most = std::max(most, leaf.size());
    }
    const double mean = static_cast<double>(sphere.triangles.size()) / static_cast<double>(leaves.size());
    EXPECT_GE(mean, 24) << frequency;
    EXPECT_LE(mean, 48) << frequency;
    EXPECT_LE(static_cast<double>(most), 1.7 * mean) << frequency;
    EXPECT_GE(static_cast<double>(least), 0.5 * mean) << frequency;
    std::size_t children = 0;
    for (const OctreeNode& node : topology.nodes) children += node.child_count;
    EXPECT_GE(static_cast<double>(children), 5.5 * static_cast<double>(topology.nodes.size())) << frequency;
  }
}

TEST(BalancedBuild, LeavesOfCrossingThreadsTileTheSquare) {
  // Strips that cross the whole square, half of them along x and half along z.
  TriangleMesh mesh;
  for (std::uint32_t thread = 0; thread < 64; ++thread) {
    const TriangleMesh sheet = crumpled_sheet(64, 1, 0, 0);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& p : sheet.positions) {
      const double along = p.x, across = (thread / 2 + p.z) / 32.0;
      mesh.positions.push_back(thread % 2 == 0 ? Vec3d{along, 0, across} : Vec3d{across, 0, along});
    }
    for (const Triangle& t : sheet.triangles) {
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  const std::vector<Vec3d> centers = centers_of(mesh);
  double area = 0;
  for (const auto& leaf : leaves_of(built(mesh))) {
    double low_x = 1, high_x = 0, low_z = 1, high_z = 0;
    for (const std::uint32_t t : leaf) {
      low_x = std::min(low_x, centers[t].x);
      high_x = std::max(high_x, centers[t].x);
      low_z = std::min(low_z, centers[t].z);
      high_z = std::max(high_z, centers[t].z);
    }
    area += (high_x - low_x) * (high_z - low_z);
  }
  EXPECT_LT(area, 1.5) << "leaves tile the square";
}

TEST(BalancedBuild, LeavesDoNotMixConnectedParts) {
  TriangleMesh mesh = crumpled_sheet(40, 30, 0, 0);
  const std::size_t part_size = mesh.triangles.size();
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  for (int copy = 1; copy < 3; ++copy) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t v = 0; v < vertices; ++v)
      mesh.positions.push_back(mesh.positions[v] + Vec3d{0, 0.5 * copy, 0});
    for (std::size_t t = 0; t < part_size; ++t) {
      const Triangle original = mesh.triangles[t];
      mesh.triangles.push_back({original[0] + first, original[1] + first, original[2] + first});
    }
  }
  for (const auto& leaf : leaves_of(built(mesh))) {
    for (const std::uint32_t t : leaf) EXPECT_EQ(t / part_size, leaf.front() / part_size);
  }
}

TEST(BalancedBuild, CutsGridsBetweenRows) {
  for (const auto& [columns, rows] : {std::pair{40u, 30u}, {24u, 24u}, {100u, 50u}, {64u, 64u}}) {
    const TriangleMesh sheet = crumpled_sheet(columns, rows, 0, 0);
    // The two triangles of a square get the same centre.
    std::vector<Vec3d> centers = centers_of(sheet);
    for (std::size_t t = 0; t < centers.size(); t += 2) centers[t] = centers[t + 1];
    const OctreeTopology topology = build_balanced_octree(centers, sheet.triangles, {});
    std::size_t straight = 0;
    const auto leaves = leaves_of(topology);
    for (const auto& leaf : leaves) {
      std::uint32_t left = columns, right = 0, top = rows, bottom = 0;
      for (const std::uint32_t t : leaf) {
        const std::uint32_t column = t / 2 % columns, row = t / 2 / columns;
        left = std::min(left, column);
        right = std::max(right, column);
        top = std::min(top, row);
        bottom = std::max(bottom, row);
      }
      straight += leaf.size() == 2 * std::size_t{right - left + 1} * (bottom - top + 1) ? 1 : 0;
    }
    EXPECT_EQ(straight, leaves.size()) << columns << " x " << rows;
  }
}

TEST(BalancedBuild, SplitsEqualTrianglesInTheirOrder) {
  TriangleMesh mesh = random_soup(200, 1, 0.1, 3);
  std::fill(mesh.positions.begin(), mesh.positions.end(), Vec3d{1, 1, 1});
  const OctreeTopology topology = built(mesh, {.leaf_size = 16});
  std::vector<std::uint32_t> all(200);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(topology.order, all);
  EXPECT_EQ(topology.nodes.size(), 5u);
}

TEST(BalancedBuild, SeparatesTheRestWhenOneVertexIsFarAway) {
  for (const double far : {1e10, 1e30, 1e300}) {
    for (const std::size_t at : {0u, 500u, 1000u, 1999u}) {
      TriangleMesh mesh = random_soup(2000, 1, 0.01, 4);
      mesh.positions[3 * at] = {far, far, -far};
      const std::vector<Vec3d> centers = centers_of(mesh);
      std::size_t small = 0;
      const auto leaves = leaves_of(built(mesh));
      for (const auto& leaf : leaves) {
        Vec3d low{1, 1, 1}, high{-1, -1, -1};
        for (const std::uint32_t t : leaf) {
          for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], centers[t][axis]);
            high[axis] = std::max(high[axis], centers[t][axis]);
          }
        }
        const Vec3d size = high - low;
        small += size.x * size.y * size.z < 0.5 ? 1 : 0;
      }
      // If a vertex is at 1e300, floats distinguish the other vertices only after a cut that separates it.
      EXPECT_GE(small + (far > 1e100 ? 20 : 8), leaves.size()) << far << ' ' << at;
    }
  }
}

}  // namespace
}  // namespace supple
