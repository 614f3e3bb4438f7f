#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/studies/arity.hpp"
#include "experiments/studies/box_field.hpp"
#include "experiments/studies/scaling.hpp"
#include "experiments/studies/shape_pair.hpp"
#include "experiments/table1/paper_table.hpp"
#include "supple/models.hpp"

namespace supple::experiments::experiments_test {

TEST(PaperTable, AveragesAreThoseOfTheTextButForOne) {
  for (const PaperRow& row : paper_rows()) {
    const bool is_the_one = row.objects == 9 && row.volume == BoundingVolume::aabb;
    EXPECT_NEAR(seconds_per_collision(row.broad), row.text_seconds_broad, is_the_one ? 0.012 : 0.01);
    EXPECT_NEAR(seconds_per_collision(row.narrow), row.text_seconds_narrow, 0.01);
  }
  EXPECT_NEAR(mean(paper_row(3, BoundingVolume::sphere)->broad), 12.4, 1e-12);
  EXPECT_EQ(paper_row(4, BoundingVolume::sphere), nullptr);
}

TEST(PaperTable, TellsWhatTheTextCutOff) {
  const Table table = paper_arithmetic();
  ASSERT_EQ(table.rows.size(), 12u);
  const auto comparison = [&](std::size_t row) { return std::get<std::string>(table.rows[row].back()); };
  EXPECT_EQ(comparison(0), "agrees");                // 600 / 24.6 = 24.390
  EXPECT_EQ(comparison(2), "cut off, not rounded");  // 600 / 12.4 = 48.387, the text has 48.38
  EXPECT_EQ(comparison(8), "differs");               // 600 / 83.2 = 7.2115, the text has 7.20
  for (std::size_t row = 0; row < 12; ++row) {
    if (row != 8) {
      EXPECT_NE(comparison(row), "differs") << row;
    }
  }
}

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
  const PairCost eight = cost_of_pair(ball, other, {.leaf_size = 1}, 1, 1);
  EXPECT_GT(eight.stats.candidate_pairs, 0u);
  for (const std::uint32_t arity : {2u, 4u}) {
    const PairCost cost = cost_of_pair(ball, other, {.leaf_size = 1, .arity = arity}, 1, 1);
    EXPECT_EQ(cost.stats.candidate_pairs, eight.stats.candidate_pairs);
    EXPECT_GT(cost.stats.node_pairs_visited, eight.stats.node_pairs_visited);
    EXPECT_GT(cost.octree_a.depth, eight.octree_a.depth);
  }
}

/// All cells of the columns whose names contain none of the given words.
std::vector<std::string> columns_of(const Table& table, const std::vector<std::string>& skipped) {
  std::vector<std::string> text;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    bool taken = true;
    for (const std::string& word : skipped)
      taken = taken && table.columns[c].name.find(word) == std::string::npos;
    for (const auto& row : table.rows)
      if (taken) text.push_back(text_of(row[c], table.columns[c]));
  }
  return text;
}

const Table& table_of(const Report& report, const std::string& name) {
  for (const Section& section : report.sections)
    for (const Table& table : section.tables)
      if (table.name == name) return table;
  throw std::runtime_error("no table " + name);
}

ScalingOptions tiny_scaling(std::uint32_t threads) {
  ScalingOptions options;
  options.object_counts = {100, 200, 400};
  options.frequencies = {2, 4, 8};
  options.frames = 2;
  options.threads = threads;
  return options;
}

TEST(Scaling, CountsDoNotDependOnThreads) {
  const Report one = run_scaling(tiny_scaling(1), false), three = run_scaling(tiny_scaling(3), false);
  EXPECT_EQ(columns_of(table_of(one, "scaling_broad_phase"), {"_ms"}),
            columns_of(table_of(three, "scaling_broad_phase"), {"_ms"}));
  // With several threads, the descent starts from more pairs of nodes.
  const std::vector<std::string> of_one_thread{"_ms", "node_pairs", "tests"};
  EXPECT_EQ(columns_of(table_of(one, "scaling_vertices"), of_one_thread),
            columns_of(table_of(three, "scaling_vertices"), of_one_thread));
  EXPECT_EQ(table_of(one, "scaling_broad_phase").rows.size(), 15u);
}

TEST(Scaling, BruteForceTestsAllPairsAndStopsInTime) {
  ScalingOptions options = tiny_scaling(1);
  const Report report = run_scaling(options, false);
  const auto& rows = table_of(report, "scaling_broad_phase").rows;
  EXPECT_EQ(std::get<std::uint64_t>(rows[4][4]), 4950u);
  const auto claim = std::find_if(report.claims.begin(), report.claims.end(),
                                  [](const Claim& each) { return each.id == "brute-force"; });
  ASSERT_NE(claim, report.claims.end());
  EXPECT_EQ(claim->verdict, Verdict::holds) << claim->reason;
  options.brute_seconds = 0;
  const auto stopped = table_of(run_scaling(options, false), "scaling_broad_phase").rows;
  EXPECT_TRUE(std::holds_alternative<std::uint64_t>(stopped[4][4])) << "the smallest is always measured";
  EXPECT_TRUE(std::holds_alternative<std::monostate>(stopped[9][4]));
}

TEST(Arity, HasEveryArity) {
  ArityOptions options;
  options.frequency = 4;
  options.rings = 12;
  options.box_counts = {100, 300};
  options.with_bikes = false;
  options.frames = 1;
  const Report report = run_arity(options, false);
  const auto& rows = table_of(report, "arity_objects").rows;
  ASSERT_EQ(rows.size(), 30u);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(std::get<std::uint64_t>(rows[i][2]), 2u << (i % 3));
  const auto& scenes = table_of(report, "arity_scene").rows;
  ASSERT_EQ(scenes.size(), 6u);
  for (std::size_t i = 0; i < 6; i += 3) {
    EXPECT_EQ(scenes[i].back(), scenes[i + 1].back());
    EXPECT_EQ(scenes[i].back(), scenes[i + 2].back());
  }
}

}  // namespace supple::experiments::experiments_test
