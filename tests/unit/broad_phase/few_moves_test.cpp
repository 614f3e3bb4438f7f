#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "broad_phase/octree_broad_phase.hpp"
#include "broad_phase/pair_patch.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "supple/broad_phase.hpp"
#include "supple/error.hpp"
#include "support/instruction_sets.hpp"
#include "unit/broad_phase/volume_scenes.hpp"

namespace supple {
namespace {

using test::box_around;
using test::kInfinity;
using test::Random;

template <class Volume>
std::vector<IndexPair> double_loop(const std::vector<Volume>& volumes) {
  std::vector<IndexPair> pairs;
  for (std::uint32_t a = 0; a < volumes.size(); ++a)
    for (std::uint32_t b = a + 1; b < volumes.size(); ++b)
      if (!volumes[a].empty() && !volumes[b].empty() && overlap(volumes[a], volumes[b]))
        pairs.push_back({a, b});
  return pairs;
}

TEST(PairPatch, TogglesPairsOfASortedList) {
  Random random(1);
  PairPatch patch;
  std::vector<IndexPair> pairs;
  std::set<IndexPair> expected;
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t side = round % 3 == 0 ? 4 : 40;
    std::vector<std::uint64_t> toggled;
    for (std::uint32_t i = random.below(60); i != 0; --i) {
      // Rounds that mostly add and rounds that mostly take away, and pairs that come twice.
      IndexPair pair{random.below(side), random.below(side)};
      if (round % 7 >= 4 && !pairs.empty())
        pair = pairs[random.below(static_cast<std::uint32_t>(pairs.size()))];
      toggled.push_back(std::uint64_t{pair.a} << 32 | pair.b);
      if (!expected.insert(pair).second) expected.erase(pair);
    }
    patch.toggle(toggled, pairs);
    ASSERT_EQ(pairs, std::vector<IndexPair>(expected.begin(), expected.end())) << round;
  }
  EXPECT_GT(expected.size(), 50u);
}

/// A box of any kind: most of them like the others of the scene, some far off, huge, flat, empty or infinite.
Aabb any_box(Random& random, float side, float size) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
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
      return {{-kInfinity, center.y, center.z}, {kInfinity, center.y, center.z}};
    case 5:
      return {{center.x, center.y, kNaN}, center + half};
    case 6:
      return box_around(center * 1e36f, half);
    case 7:  // on whole numbers: many touch
      return {{std::floor(center.x), std::floor(center.y), std::floor(center.z)},
              {std::floor(center.x) + 1, std::floor(center.y) + 1, std::floor(center.z) + 1}};
    default:
      return box_around(center, half);
  }
}

/// Drifts, or is somewhere else.
Aabb moved(const Aabb& box, Random& random, float side, float size) {
  if (random.below(3) == 0) return any_box(random, side, size);
  const Vec3f by = random.point(-0.3f * size, 0.3f * size);
  return {box.min + by, box.max + by};
}

TEST(BroadPhase, ToldOfChangesOrNotFindsThePairsOfADoubleLoop) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    Random random(seed);
    const float side = seed == 1 ? 20.0f : 6.0f, size = seed == 3 ? 1.5f : 0.5f;
    std::vector<Aabb> boxes = test::random_boxes(400, side, size, seed);
    std::vector<BroadPhase> told, mixed, by_balls;
    for (const BroadPhaseMethod method : {BroadPhaseMethod::octree, BroadPhaseMethod::sweep}) {
      for (const bool always_regions : {false, true}) {
        SceneOctreeOptions octree;
        octree.always_regions = always_regions;
        for (std::vector<BroadPhase>* kind : {&told, &mixed, &by_balls})
          kind->emplace_back(BroadPhaseOptions{method, octree, 1});
      }
    }
    for (int step = 0; step < 120; ++step) {
      // Mostly few, sometimes all or none; some come, some go.
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
      const std::vector<IndexPair> expected_of_balls = double_loop(spheres);
      for (std::size_t k = 0; k < told.size(); ++k) {
        const auto is_right = [&](std::span<const IndexPair> found, const BroadPhase& by,
                                  const std::vector<IndexPair>& right) {
          EXPECT_EQ(by.validate(), "") << "method " << k << ", step " << step;
          return std::equal(found.begin(), found.end(), right.begin(), right.end());
        };
        ASSERT_TRUE(is_right(told[k].find_object_pairs(boxes, changed), told[k], expected)) << step;
        ASSERT_TRUE(is_right(by_balls[k].find_object_pairs(spheres, changed), by_balls[k], expected_of_balls))
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
    BroadPhase few({.method = BroadPhaseMethod::octree, .scene_octree = {}, .threads = 2});
    for (int step = 0; step < 40; ++step) {
      std::vector<std::uint32_t> changed;
      for (std::uint32_t k = 0; k < 4; ++k) {
        // Exchanges, so that the scene stays what it is.
        const std::uint32_t i = random.below(static_cast<std::uint32_t>(boxes.size()));
        const std::uint32_t j = random.below(static_cast<std::uint32_t>(boxes.size()));
        std::swap(boxes[i], boxes[j]);
        if (k == 0) boxes[i].max.x = boxes[i].max.x + 0.125f * std::fabs(boxes[i].max.x);
        changed.insert(changed.end(), {i, j});
      }
      const auto found = few.find_object_pairs(boxes, changed);
      const std::vector<IndexPair> expected = double_loop(boxes);
      ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()))
          << scene.name << ", step " << step;
      ASSERT_EQ(few.validate(), "") << scene.name << ", step " << step;
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
  // After balls all boxes are new, whatever the list says.
  const std::vector<BoundingSphere> spheres = test::spheres_in(boxes);
  broad_phase.find_object_pairs(spheres, right);
  EXPECT_EQ(broad_phase.find_object_pairs(boxes, right).size(), expected.size());
}

TEST(BroadPhase, SeesWhatAListLeftOutWhenAListHasItOrNoneIsGiven) {
  std::vector<Aabb> boxes = test::random_boxes(300, 10, 0.5f, 7);
  BroadPhase broad_phase;
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

/// Steps an octree of either kind and compares.
class TwoKinds {
 public:
  const BroadPhaseStats& step(const std::vector<Aabb>& boxes) {
    const ObjectVolumes volumes{.boxes = boxes, .spheres = {}};
    const auto found = finder_.find_pairs(volumes, parallel_),
               expected = by_regions_.find_pairs(volumes, parallel_);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));
    EXPECT_EQ(finder_.validate(), "");
    EXPECT_EQ(finder_.stats().objects_changed, by_regions_.stats().objects_changed);
    return finder_.stats();
  }
  const OctreeBroadPhase& finder() const { return finder_; }

 private:
  Parallel parallel_{1};
  OctreeBroadPhase finder_{BoundingVolume::aabb, {}};
  OctreeBroadPhase by_regions_{BoundingVolume::aabb, {.always_regions = true}};
};

TEST(OctreeBroadPhase, LooksOnlyAroundTheFewThatMove) {
  TwoKinds kinds;
  std::vector<Aabb> boxes = test::random_boxes(2000, 19, 0.5f, 8);
  Random random(9);
  kinds.step(boxes);
  EXPECT_GT(kinds.finder().regions().size(), 8u) << "regions are there for who asks";
  for (int i = 0; i < 20; ++i) {
    for (std::size_t k = 0; k < 10; ++k) {
      const Vec3f by = random.point(-0.2f, 0.2f);
      boxes[100 * k] = {boxes[100 * k].min + by, boxes[100 * k].max + by};
    }
    const BroadPhaseStats stats = kinds.step(boxes);
    EXPECT_EQ(stats.objects_paired, 10u);
    EXPECT_EQ(stats.regions_rebuilt, 0u);
    EXPECT_LT(stats.object_pairs_tested, 10u * 400u);
  }
  const BroadPhaseStats still = kinds.step(boxes);
  EXPECT_EQ(still.objects_paired + still.object_pairs_tested, 0u);
}

TEST(OctreeBroadPhase, MovesFewAlikeWithEveryInstructionSetAndNumberOfThreads) {
  std::vector<std::vector<IndexPair>> expected;
  std::uint64_t expected_tests = 0;
  const auto run = [&](std::uint32_t threads, const std::string& name) {
    BroadPhase broad_phase({.method = BroadPhaseMethod::octree, .scene_octree = {}, .threads = threads});
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

TEST(OctreeBroadPhase, DealsBoxesOutAnewWhenTheyHaveMovedFar) {
  // A few at a time go to a corner far from where all were: no cell there has room, and all would be in it.
  TwoKinds kinds;
  std::vector<Aabb> boxes = test::random_boxes(1500, 15, 0.5f, 10);
  Random random(11);
  kinds.step(boxes);
  std::size_t anew = 0;
  for (std::size_t i = 0; i < boxes.size(); i += 50) {
    for (std::size_t k = i; k < i + 50; ++k)
      boxes[k] = box_around(random.point(1000, 1012), {0.2f, 0.2f, 0.2f});
    anew += kinds.step(boxes).objects_paired > 50;
  }
  EXPECT_GE(anew, 1u);
  EXPECT_LE(anew, 20u);
}

TEST(OctreeBroadPhase, CountsAndKeepsWhatChangedHoweverManyDid) {
  TwoKinds kinds;
  constexpr float kSide = 40;
  std::vector<Aabb> boxes = test::random_boxes(20'000, kSide, 0.5f, 12);
  Random random(13);
  for (const std::uint32_t one_in : {1u, 1u, 0u, 1u, 100u, 2u, 3u, 1u, 8u, 1u, 2000u, 1u, 1u}) {
    for (Aabb& box : boxes)
      if (one_in != 0 && random.below(one_in) == 0) box = moved(box, random, kSide, 0.5f);
    kinds.step(boxes);
    if (one_in == 3) boxes.resize(boxes.size() - 1500);
    if (one_in == 8) boxes.insert(boxes.end(), 2000, box_around({1, 2, 3}, {0.01f, 0.01f, 0.01f}));
  }
  EXPECT_EQ(boxes.size(), 20'500u);
}

}  // namespace
}  // namespace supple
