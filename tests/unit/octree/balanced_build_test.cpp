#include "octree/build/balanced_build.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "support/instruction_sets.hpp"
#include "support/soups.hpp"
#include "support/topologies.hpp"

namespace supple::balanced_build_test {

OctreeTopology built(const TriangleMesh& mesh, const ObjectOctreeOptions& options = {},
                     std::uint32_t threads = 1) {
  return build_balanced_octree(centers_of(mesh), mesh.triangles, options, Parallel(threads));
}

TEST(BalancedBuild, IsSoundForAnySizesOptionsAndPositions) {
  RandomNumbers random(1);
  for (std::uint32_t count = 0; count < 700; count += 1 + count / 3) {
    for (std::uint32_t way = 0; way < hard_ways; ++way) {
      for (const bool in_parts : {false, true}) {
        const TriangleMesh mesh = in_parts ? random_soup(count, 1, 0.1, count)
                                           : crumpled_sheet(count == 0 ? 0 : 1 + count / 8, 4, 0.1, count);
        const ObjectOctreeOptions options{.max_level = random.below(4) == 0 ? random.below(4) : 16,
                                          .leaf_size = 1 + random.below(random.below(2) == 0 ? 4 : 70)};
        SCOPED_TRACE(std::to_string(count) + " way " + std::to_string(way) + " leaf size " +
                     std::to_string(options.leaf_size) + " level " + std::to_string(options.max_level));
        expect_sound(built(hard_positions(mesh, way, random), options), mesh.triangles.size(), options,
                     options.max_level);
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
    const OctreeTopology topology = build_balanced_octree(centers, sheet.triangles, {}, Parallel(1));
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

TEST(BalancedBuild, IsTheSameOnEveryInstructionSetAndNumberOfThreads) {
  RandomNumbers random(3);
  for (const std::uint32_t count : {1u, 17u, 300u, 9000u}) {
    for (std::uint32_t way = 0; way < hard_ways; ++way) {
      const TriangleMesh mesh =
          way % 2 == 0 ? random_soup(count, 1, 0.1, count) : crumpled_sheet(1 + count / 8, 4, 0.1, count);
      const TriangleMesh hard = hard_positions(mesh, way, random);
      const std::vector<std::uint32_t> order = built(hard).order;
      for (const std::uint32_t threads : {2u, 7u}) EXPECT_EQ(built(hard, {}, threads).order, order);
      for_each_target([&](const char* name) { EXPECT_EQ(built(hard).order, order) << name; });
    }
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

}  // namespace supple::balanced_build_test
