#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "supple/broad_phase.hpp"
#include "supple/error.hpp"
#include "support/instruction_sets.hpp"
#include "unit/broad_phase/volume_scenes.hpp"

namespace supple::dirty_list_test {

using test::box_around;
using test::double_loop;
using test::infinity;
using test::Random;

/// A random box. Most boxes are ordinary; some are distant, huge, flat, empty or infinite.
Aabb any_box(Random& random, float side, float size) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const Vec3f center = random.point(0, side), half = random.point(0.1f * size, size);
  switch (random.below(24)) {
    case 0:
      return Aabb{};
    case 1:
      return box_around(center, half * 20.0f);
    case 2:
      return box_around(random.point(-9 * side, 9 * side), half);
    case 3:
      return box_around(center, {0, 0, 0});
    case 4:
      return {{-infinity, center.y, center.z}, {infinity, center.y, center.z}};
    case 5:
      return {{center.x, center.y, nan}, center + half};
    case 6:
      return box_around(center * 1e36f, half);
    case 7:  // integer coordinates, so many boxes touch
      return {{std::floor(center.x), std::floor(center.y), std::floor(center.z)},
              {std::floor(center.x) + 1, std::floor(center.y) + 1, std::floor(center.z) + 1}};
    default:
      return box_around(center, half);
  }
}

/// A box that has drifted, or a new random box.
Aabb moved(const Aabb& box, Random& random, float side, float size) {
  if (random.below(3) == 0) return any_box(random, side, size);
  const Vec3f by = random.point(-0.3f * size, 0.3f * size);
  return {box.min + by, box.max + by};
}

TEST(BroadPhase, WithADirtyListOrWithoutFindsThePairsOfADoubleLoop) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    Random random(seed);
    const float side = seed == 1 ? 20.0f : 6.0f, size = seed == 3 ? 1.5f : 0.5f;
    std::vector<Aabb> boxes = test::random_boxes(400, side, size, seed);
    std::vector<BroadPhase> listed, mixed, by_spheres;
    for (std::vector<BroadPhase>* kind : {&listed, &mixed, &by_spheres})
      for (const BroadPhaseMethod method : test::all_methods)
        kind->emplace_back(BroadPhaseOptions{.method = method, .scene_octree = {}, .threads = 1});
    for (int step = 0; step < 120; ++step) {
      // Usually few objects change, sometimes all or none; objects are added and removed.
      const std::uint32_t one_in = step % 17 == 16 ? 1 : step % 11 == 10 ? 5 : 40;
      std::vector<std::uint32_t> changed;
      if (step == 50) boxes.resize(boxes.size() - 3);
      if (step == 60) boxes.resize(boxes.size() / 2);
      for (std::uint32_t i = 0; i < boxes.size() && step % 9 != 8; ++i) {
        if (random.below(one_in) != 0) continue;
        boxes[i] = moved(boxes[i], random, side, size);
        changed.push_back(i);
        if (random.below(4) == 0) changed.push_back(random.below(static_cast<std::uint32_t>(boxes.size())));
      }
      for (std::size_t i = changed.size(); i > 1 && step % 2 == 0; --i)
        std::swap(changed[i - 1], changed[random.below(static_cast<std::uint32_t>(i))]);
      if (step % 13 == 5 || step == 61) boxes.push_back(any_box(random, side, size));
      const std::vector<IndexPair> expected = double_loop(boxes);
      const std::vector<BoundingSphere> spheres = test::spheres_in(boxes);
      const std::vector<IndexPair> expected_of_spheres = double_loop(spheres);
      for (std::size_t k = 0; k < listed.size(); ++k) {
        const auto is_right = [&](std::span<const IndexPair> found, const BroadPhase& by,
                                  const std::vector<IndexPair>& right) {
          EXPECT_EQ(by.validate(), "") << "method " << k << ", step " << step;
          return std::equal(found.begin(), found.end(), right.begin(), right.end());
        };
        ASSERT_TRUE(is_right(listed[k].find_object_pairs(boxes, changed), listed[k], expected)) << step;
        ASSERT_TRUE(
            is_right(by_spheres[k].find_object_pairs(spheres, changed), by_spheres[k], expected_of_spheres))
            << step;
        ASSERT_TRUE(is_right(
            step % 3 == 0 ? mixed[k].find_object_pairs(boxes) : mixed[k].find_object_pairs(boxes, changed),
            mixed[k], expected))
            << step;
      }
    }
  }
}

TEST(BroadPhase, FollowsFewThatMoveInHardScenes) {
  for (const test::NamedBoxes& scene : test::box_scenes()) {
    if (scene.boxes.size() < 20) continue;
    Random random(5);
    std::vector<Aabb> boxes = scene.boxes;
    std::vector<BroadPhase> all;
    for (const BroadPhaseMethod method : test::all_methods)
      all.emplace_back(BroadPhaseOptions{.method = method, .scene_octree = {}, .threads = 2});
    for (int step = 0; step < 40; ++step) {
      std::vector<std::uint32_t> changed;
      for (std::uint32_t k = 0; k < 4; ++k) {
        // Boxes are exchanged, so the scene as a whole stays the same.
        const std::uint32_t i = random.below(static_cast<std::uint32_t>(boxes.size()));
        const std::uint32_t j = random.below(static_cast<std::uint32_t>(boxes.size()));
        std::swap(boxes[i], boxes[j]);
        if (k == 0) boxes[i].max.x = boxes[i].max.x + 0.125f * std::fabs(boxes[i].max.x);
        changed.insert(changed.end(), {i, j});
      }
      const std::vector<IndexPair> expected = double_loop(boxes);
      for (BroadPhase& broad_phase : all) {
        const auto found = broad_phase.find_object_pairs(boxes, changed);
        ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()))
            << scene.name << ", step " << step;
        ASSERT_EQ(broad_phase.validate(), "") << scene.name << ", step " << step;
      }
    }
  }
}

TEST(BroadPhase, RefusesAListWithNumbersOfNoVolumes) {
  BroadPhase broad_phase;
  const std::vector<Aabb> boxes = test::random_boxes(30, 4, 0.5f, 6);
  const std::vector<std::uint32_t> wrong{3, 30};
  EXPECT_THROW(broad_phase.find_object_pairs(boxes, wrong), Error);
  const std::vector<std::uint32_t> right{3, 29};
  const auto found = broad_phase.find_object_pairs(boxes, right);
  const std::vector<IndexPair> expected = double_loop(boxes);
  EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));
  // After a search with spheres, all boxes count as changed, whatever the list contains.
  const std::vector<BoundingSphere> spheres = test::spheres_in(boxes);
  broad_phase.find_object_pairs(spheres, right);
  EXPECT_EQ(broad_phase.find_object_pairs(boxes, right).size(), expected.size());
}

TEST(BroadPhase, SeesWhatAListLeftOutWhenAListHasItOrNoneIsGiven) {
  for (const BroadPhaseMethod method : test::all_methods) {
    std::vector<Aabb> boxes = test::random_boxes(300, 10, 0.5f, 7);
    BroadPhase broad_phase({.method = method});
    const std::vector<IndexPair> before = double_loop(boxes);
    broad_phase.find_object_pairs(boxes);
    boxes[4] = box_around({5, 5, 5}, {4, 4, 4});
    boxes[9] = box_around({2, 5, 5}, {3, 3, 3});
    const std::vector<std::uint32_t> nothing, four{4};
    const auto equals = [](std::span<const IndexPair> found, const std::vector<IndexPair>& expected) {
      return std::equal(found.begin(), found.end(), expected.begin(), expected.end());
    };
    EXPECT_TRUE(equals(broad_phase.find_object_pairs(boxes, nothing), before));
    EXPECT_EQ(broad_phase.stats().objects_changed, 0u);
    std::vector<Aabb> seen = boxes;
    seen[9] = test::random_boxes(300, 10, 0.5f, 7)[9];
    EXPECT_TRUE(equals(broad_phase.find_object_pairs(boxes, four), double_loop(seen)));
    EXPECT_EQ(broad_phase.stats().objects_changed, 1u);
    EXPECT_TRUE(equals(broad_phase.find_object_pairs(boxes), double_loop(boxes)));
    EXPECT_EQ(broad_phase.stats().objects_changed, 1u);
  }
}

class Automatic {
 public:
  explicit Automatic(BroadPhaseOptions options = {}) : broad_phase_(options) {}
  /// Compares the pairs and the count of changed objects with those of brute force.
  const BroadPhaseStats& step(const std::vector<Aabb>& boxes) {
    const auto found = broad_phase_.find_object_pairs(boxes), expected = brute_.find_object_pairs(boxes);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));
    EXPECT_EQ(broad_phase_.validate(), "");
    EXPECT_EQ(broad_phase_.stats().objects_changed, brute_.stats().objects_changed);
    EXPECT_EQ(broad_phase_.regions().empty(), broad_phase_.stats().method != BroadPhaseMethod::octree);
    return broad_phase_.stats();
  }

 private:
  BroadPhase broad_phase_;
  BroadPhase brute_{BroadPhaseOptions{.method = BroadPhaseMethod::brute}};
};

void move_some(std::vector<Aabb>& boxes, std::size_t count, Random& random) {
  for (std::size_t k = 0; k < count; ++k) {
    Aabb& box = boxes[k * (boxes.size() / count)];
    const Vec3f by = random.point(-0.2f, 0.2f);
    box = {box.min + by, box.max + by};
  }
}

TEST(AutomaticSearch, RunsTheOctreeFromTheFourthStepInARowInWhichFewChange) {
  Automatic automatic;
  std::vector<Aabb> boxes = test::random_boxes(2000, 19, 0.5f, 8);
  Random random(9);
  EXPECT_EQ(automatic.step(boxes).method, BroadPhaseMethod::grid);
  std::uint64_t rebuilt = 0;
  for (int round = 0; round < 3; ++round) {
    for (int i = 1; i <= 20; ++i) {
      move_some(boxes, 10, random);
      const BroadPhaseStats stats = automatic.step(boxes);
      EXPECT_EQ(stats.method, i < 4 ? BroadPhaseMethod::grid : BroadPhaseMethod::octree) << i;
      rebuilt += stats.regions_rebuilt;
      if (i < 4) continue;
      EXPECT_EQ(stats.objects_paired, 10u);
      EXPECT_LT(stats.object_pairs_tested, 10u * 400u);
      const BroadPhaseStats still = automatic.step(boxes);
      EXPECT_EQ(still.objects_paired + still.object_pairs_tested, 0u);
      EXPECT_EQ(still.method, BroadPhaseMethod::octree);
    }
    move_some(boxes, 200, random);
    EXPECT_EQ(automatic.step(boxes).method, BroadPhaseMethod::grid);
  }
  EXPECT_EQ(rebuilt, 3u) << "once in each round";
}

TEST(AutomaticSearch, DoesNotBuildRegionsWhenFewAndManyChangesTakeTurns) {
  Automatic automatic;
  std::vector<Aabb> boxes = test::random_boxes(1000, 15, 0.5f, 10);
  Random random(11);
  for (int i = 0; i < 40; ++i) {
    move_some(boxes, i % 4 == 3 ? 500 : 5, random);
    EXPECT_EQ(automatic.step(boxes).method, BroadPhaseMethod::grid) << i;
  }
}

TEST(AutomaticSearch, LeavesCrowdsToTheOctreeForSomeSteps) {
  // Two dense clusters in a wide scene. No cell size of the grid separates their boxes; the regions do.
  Random random(12);
  std::vector<Aabb> boxes = test::random_boxes(1500, 1, 0.01f, 13);
  boxes.push_back(box_around({1e6f, 1e6f, 1e6f}, {1, 1, 1}));
  boxes.insert(boxes.end(), 200, boxes.back());
  Automatic automatic;
  std::size_t octrees = 0;
  for (int i = 0; i < 70; ++i) {
    for (Aabb& box : boxes) box = {box.min + Vec3f{0.001f, 0, 0}, box.max + Vec3f{0.001f, 0, 0}};
    octrees += automatic.step(boxes).method == BroadPhaseMethod::octree;
  }
  EXPECT_EQ(octrees, 70u);
  boxes = test::random_boxes(1701, 19, 0.5f, 14);
  std::size_t steps = 0;
  for (; steps < 100 && automatic.step(boxes).method == BroadPhaseMethod::octree; ++steps)
    for (Aabb& box : boxes) box = {box.min + Vec3f{0.01f, 0, 0}, box.max + Vec3f{0.01f, 0, 0}};
  EXPECT_LE(steps, 64u) << "the automatic method returns to the grid";
}

TEST(BroadPhase, FewMoveAlikeWithEveryInstructionSetAndNumberOfThreads) {
  for (const BroadPhaseMethod method : test::all_methods) {
    std::vector<std::vector<IndexPair>> expected;
    std::uint64_t expected_tests = 0;
    const auto run = [&](std::uint32_t threads, const std::string& name) {
      BroadPhase broad_phase({.method = method, .scene_octree = {}, .threads = threads});
      Random random(12);
      std::vector<Aabb> boxes = test::random_boxes(2500, 12, 0.5f, 13);
      std::uint64_t tests = 0;
      for (std::size_t step = 0; step < 12; ++step) {
        for (Aabb& box : boxes)
          if (step != 0 && random.below(50) == 0) box = moved(box, random, 12, 0.5f);
        const auto found = broad_phase.find_object_pairs(boxes);
        tests += broad_phase.stats().object_pairs_tested;
        if (step == expected.size()) expected.emplace_back(found.begin(), found.end());
        EXPECT_TRUE(std::equal(found.begin(), found.end(), expected[step].begin(), expected[step].end()))
            << name;
      }
      if (expected_tests == 0) expected_tests = tests;
      EXPECT_EQ(tests, expected_tests) << name;
    };
    for (const std::uint32_t threads : {1u, 2u, 5u}) run(threads, std::to_string(threads) + " threads");
    for_each_target([&](const char* name) { run(1, name); });
    EXPECT_GT(expected.back().size(), 1000u);
  }
}

TEST(AutomaticSearch, CountsWhatChangedHoweverManyDid) {
  Automatic automatic;
  constexpr float side = 25;
  std::vector<Aabb> boxes = test::random_boxes(5'000, side, 0.5f, 12);
  Random random(13);
  for (const std::uint32_t one_in :
       {1u, 1u, 0u, 1u, 100u, 2u, 3u, 1u, 8u, 1u, 200u, 200u, 200u, 200u, 200u, 1u, 1u}) {
    for (Aabb& box : boxes)
      if (one_in != 0 && random.below(one_in) == 0) box = moved(box, random, side, 0.5f);
    automatic.step(boxes);
    if (one_in == 3) boxes.resize(boxes.size() - 1500);
    if (one_in == 8) boxes.insert(boxes.end(), 2000, box_around({1, 2, 3}, {0.01f, 0.01f, 0.01f}));
  }
  EXPECT_EQ(boxes.size(), 5'500u);
}

}  // namespace supple::dirty_list_test
