#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "experiments/plain/plain_broad_phase.hpp"
#include "experiments/studies/box_field.hpp"
#include "experiments/studies/shape_pair.hpp"
#include "experiments/studies/studies.hpp"
#include "supple/models.hpp"

namespace supple::experiments::experiments_test {

TEST(BoxField, StaysInItsCubeAtOneDensity) {
  BoxField field(1000, 7);
  for (int step = 0; step < 300; ++step) field.move();
  for (const Aabb& box : field.boxes()) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(box.min[axis], -0.1f);
      EXPECT_LT(box.max[axis], 20.1f);
    }
  }
  EXPECT_EQ(BoxField(10, 7).boxes(), BoxField(10, 7).boxes());
  EXPECT_NE(BoxField(10, 7).boxes(), BoxField(10, 8).boxes());
}

TEST(ShapePair, TurnsWithoutStretching) {
  const TriangleMesh ball = make_icosphere(3), other = turned(ball);
  EXPECT_NE(ball.positions, other.positions);
  for (std::size_t i = 0; i < ball.positions.size(); ++i) {
    const Vec3d p = ball.positions[i], q = other.positions[i];
    EXPECT_NEAR(p.x * p.x + p.y * p.y + p.z * p.z, q.x * q.x + q.y * q.y + q.z * q.z, 1e-12);
  }
}

TEST(ShapePair, EveryArityFindsTheSameCandidates) {
  const TriangleMesh ball = make_icosphere(6), other = moved(turned(ball), {0.5, 0, 0});
  const PairCost eight = cost_of_pair(ball, other, {.leaf_size = 1}, 1);
  EXPECT_GT(eight.stats.candidate_pairs, 0u);
  for (const std::uint32_t arity : {2u, 4u}) {
    const PairCost cost = cost_of_pair(ball, other, {.leaf_size = 1, .arity = arity}, 1);
    EXPECT_EQ(cost.stats.candidate_pairs, eight.stats.candidate_pairs);
    EXPECT_GT(cost.stats.node_pairs_visited, eight.stats.node_pairs_visited);
    EXPECT_GT(cost.octree_a.depth, eight.octree_a.depth);
  }
}

std::uint64_t count_of(const Cell& cell) {
  return std::get<std::uint64_t>(cell);
}
std::string word_of(const Cell& cell) {
  return std::get<std::string>(cell);
}

TEST(BroadPhases, AllMethodsFindTheSamePairsInEachRound) {
  BroadPhasesOptions options;
  options.object_counts = {3, 100, 400};
  options.rounds = 2;
  Work work(0, false);
  const Table table = measure_broad_phases(options, work);  // throws when pairs differ
  std::map<std::string, std::size_t> rows;
  for (const auto& row : table.rows) {
    ++rows[word_of(row[0])];
    if (word_of(row[0]) == "plain brute force") {
      const std::uint64_t boxes = count_of(row[2]);
      EXPECT_EQ(count_of(row[5]), boxes * (boxes - 1) / 2);
    }
  }
  EXPECT_EQ(rows.size(), 11u);
  for (const auto& [method, count] : rows)
    EXPECT_EQ(count, 15u) << method << ": three sizes, two with few in motion";
}

TEST(BroadPhases, QuadraticMethodsStopInTime) {
  BroadPhasesOptions options;
  options.object_counts = {100, 200};
  options.rounds = 2;
  options.longest_step = 0;
  Work work(0, false);
  const Table table = measure_broad_phases(options, work);
  const auto sizes_of = [&](const std::string& method) {
    std::set<std::uint64_t> sizes;
    for (const auto& row : table.rows)
      if (word_of(row[0]) == method) sizes.insert(count_of(row[2]));
    return sizes;
  };
  EXPECT_EQ(sizes_of("brute force"), std::set<std::uint64_t>{100}) << "the smallest is always measured";
  EXPECT_EQ(sizes_of("octree"), (std::set<std::uint64_t>{100, 200}));
}

TEST(PlainBroadPhase, FindsWhatBruteForceFindsAlsoOutsideOfTheCube) {
  for (const std::size_t count : {1u, 2u, 9u, 300u}) {
    BoxField field(count, 5);
    const RootCube cube = field.cube();
    const auto brute = plain_brute_force(), sweep = plain_sweep(), lists = plain_three_lists();
    // A cube in the middle half of the field: many boxes lie outside of it or across its faces.
    const Vec3d corner{cube.edge / 4, cube.edge / 4, cube.edge / 4};
    std::vector<std::unique_ptr<PlainBroadPhase>> octrees;
    for (const std::uint32_t level : {0u, 1u, 2u, 4u})
      octrees.push_back(plain_octree(corner, cube.edge / 2, level));
    for (int step = 0; step < 20; ++step) {
      const std::size_t pairs = brute->step(field.boxes());
      EXPECT_EQ(sweep->step(field.boxes()), pairs);
      EXPECT_EQ(lists->step(field.boxes()), pairs);
      for (const auto& octree : octrees) EXPECT_EQ(octree->step(field.boxes()), pairs);
      field.move();
    }
  }
  // Boxes that touch at a middle plane, and equal boxes.
  const std::vector<Aabb> touching{
      {{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{0, 0, 0}, {1, 1, 1}}};
  EXPECT_EQ(plain_brute_force()->step(touching), 6u);
  EXPECT_EQ(plain_octree({0, 0, 0}, 2, 3)->step(touching), 6u);
  EXPECT_EQ(plain_three_lists()->step(touching), 6u);
}

}  // namespace supple::experiments::experiments_test
