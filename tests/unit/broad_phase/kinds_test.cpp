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

namespace supple::kinds_test {

using test::box_around;
using test::double_loop;
using test::Random;

using Kinds = std::vector<std::uint8_t>;
using KindPairs = std::vector<KindPair>;

/// Vertices, edges and faces of simulators, one kind alone, kinds that are only paired with others, all
/// pairs of three kinds, and a table with repeats.
const std::vector<KindPairs> tables{{{0, 2}, {1, 1}},
                                    {{3, 3}},
                                    {{7, 0}},
                                    {{0, 1}, {2, 1}},
                                    {{0, 0}, {0, 1}},
                                    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}},
                                    {{5, 2}, {2, 5}, {2, 5}, {6, 6}, {6, 6}}};

bool are_wanted(const KindPairs& wanted, std::uint8_t a, std::uint8_t b) {
  return std::any_of(wanted.begin(), wanted.end(), [&](const KindPair& pair) {
    return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
  });
}

/// The pairs of a double loop whose kinds are wanted.
template <class Volume>
std::vector<IndexPair> expected_pairs(const std::vector<Volume>& volumes, const Kinds& kinds,
                                      const KindPairs& wanted) {
  std::vector<IndexPair> pairs = double_loop(volumes);
  std::erase_if(pairs,
                [&](const IndexPair& pair) { return !are_wanted(wanted, kinds[pair.a], kinds[pair.b]); });
  return pairs;
}

Kinds random_kinds(std::size_t count, Random& random) {
  Kinds kinds;
  while (kinds.size() < count) kinds.push_back(static_cast<std::uint8_t>(random.below(volume_kind_count)));
  return kinds;
}

template <class Volume>
std::vector<IndexPair> found_by(BroadPhase& broad_phase, const std::vector<Volume>& volumes,
                                const Kinds& kinds) {
  const auto pairs = broad_phase.find_object_pairs(std::span<const Volume>(volumes), kinds);
  EXPECT_EQ(broad_phase.validate(), "");
  return {pairs.begin(), pairs.end()};
}

template <class Volume>
std::vector<IndexPair> found_by(BroadPhase& broad_phase, const std::vector<Volume>& volumes,
                                const Kinds& kinds, const std::vector<std::uint32_t>& dirty) {
  const auto pairs = broad_phase.find_object_pairs(std::span<const Volume>(volumes), kinds, dirty);
  EXPECT_EQ(broad_phase.validate(), "");
  return {pairs.begin(), pairs.end()};
}

BroadPhaseOptions options_of(BroadPhaseMethod method, const KindPairs& wanted, std::uint32_t threads = 1) {
  return {.method = method, .scene_octree = {}, .threads = threads, .kind_pairs = wanted};
}

TEST(BroadPhaseKinds, EveryMethodFindsTheWantedPairsOfADoubleLoop) {
  Random random(1);
  std::size_t count = 0;
  for (const test::NamedBoxes& scene : test::box_scenes()) {
    const auto spheres = test::spheres_in(scene.boxes);
    for (const KindPairs& wanted : tables) {
      const Kinds kinds = random_kinds(scene.boxes.size(), random);
      const auto expected = expected_pairs(scene.boxes, kinds, wanted);
      const auto expected_of_spheres = expected_pairs(spheres, kinds, wanted);
      count += expected.size();
      for (const BroadPhaseMethod method : test::all_methods) {
        const std::string name = scene.name + ", method " + std::to_string(static_cast<int>(method));
        BroadPhase broad_phase(options_of(method, wanted));
        EXPECT_EQ(found_by(broad_phase, scene.boxes, kinds), expected) << name;
        EXPECT_EQ(found_by(broad_phase, scene.boxes, kinds), expected) << name;
        EXPECT_EQ(found_by(broad_phase, spheres, kinds), expected_of_spheres) << name;
      }
    }
  }
  EXPECT_GT(count, 10'000u);
}

TEST(BroadPhaseKinds, ReportsNoUnwantedPairAmongOverlappingVolumes) {
  // All boxes overlap one another, so each pair that is left out is left out because of its kinds.
  const std::vector<Aabb> boxes(40, box_around({1, 2, 3}, {1, 1, 1}));
  Kinds kinds;
  for (std::size_t i = 0; i < boxes.size(); ++i) kinds.push_back(static_cast<std::uint8_t>(i % 3));
  for (const BroadPhaseMethod method : test::all_methods) {
    BroadPhase broad_phase(options_of(method, {{0, 2}, {1, 1}}));
    const auto found = found_by(broad_phase, boxes, kinds);
    EXPECT_EQ(found.size(), 14u * 13u + 13u * 12u / 2u);
    for (const IndexPair& pair : found) {
      EXPECT_TRUE(kinds[pair.a] + kinds[pair.b] == 2) << pair.a << " " << pair.b;
    }
  }
}

TEST(BroadPhaseKinds, FindsTouchingVolumesAndLeavesOutEmptyOnes) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = test::infinity;
  std::vector<Aabb> boxes = test::lattice_boxes(5);
  Random random(2);
  const Kinds kinds = random_kinds(boxes.size(), random);
  boxes[3] = Aabb{};
  boxes[31].min.y = nan;
  boxes[60] = {{-infinity, 2, 2}, {infinity, 2, 2}};
  boxes[61] = {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  boxes[62] = {{infinity, 0, 0}, {infinity, 1, 1}};
  for (const KindPairs& wanted : tables) {
    for (const BroadPhaseMethod method : test::all_methods) {
      BroadPhase broad_phase(options_of(method, wanted));
      EXPECT_EQ(found_by(broad_phase, boxes, kinds), expected_pairs(boxes, kinds, wanted));
    }
  }
}

TEST(BroadPhaseKinds, FollowsChangesOfBoxesAndKindsWithADirtyListOrWithout) {
  for (const KindPairs& wanted : tables) {
    Random random(3);
    std::vector<BroadPhase> listed, compared, of_spheres;
    for (std::vector<BroadPhase>* all : {&listed, &compared, &of_spheres})
      for (const BroadPhaseMethod method : test::all_methods) all->emplace_back(options_of(method, wanted));
    std::vector<Aabb> boxes = test::random_boxes(300, 8, 0.8f, 4);
    Kinds kinds = random_kinds(boxes.size(), random);
    for (int step = 0; step < 60; ++step) {
      // Usually few volumes change, sometimes all or none.
      const std::uint32_t one_in = step % 17 == 16 ? 1 : step % 11 == 10 ? 5 : 40;
      std::vector<std::uint32_t> dirty;
      for (std::uint32_t i = 0; i < boxes.size() && step % 9 != 8; ++i) {
        if (random.below(one_in) != 0) continue;
        const std::uint32_t what = random.below(8);
        if (what < 5) kinds[i] = static_cast<std::uint8_t>(random.below(volume_kind_count));
        if (what > 2) {
          const Vec3f by = random.point(-0.4f, 0.4f);
          boxes[i] = boxes[i].empty() ? box_around(random.point(0, 8), {0.5f, 0.5f, 0.5f})
                                      : Aabb{boxes[i].min + by, boxes[i].max + by};
        }
        if (what == 7) boxes[i] = Aabb{};
        dirty.push_back(i);
      }
      if (step % 13 == 5) {
        boxes.push_back(box_around(random.point(0, 8), {0.7f, 0.7f, 0.7f}));
        kinds.push_back(static_cast<std::uint8_t>(random.below(volume_kind_count)));
      }
      if (step == 40) boxes.resize(boxes.size() / 2);
      if (step == 40) kinds.resize(boxes.size());
      if (step == 40) std::erase_if(dirty, [&](std::uint32_t i) { return i >= boxes.size(); });
      const auto spheres = test::spheres_in(boxes);
      const auto expected = expected_pairs(boxes, kinds, wanted);
      const auto expected_of_spheres = expected_pairs(spheres, kinds, wanted);
      for (std::size_t k = 0; k < listed.size(); ++k) {
        ASSERT_EQ(found_by(listed[k], boxes, kinds, dirty), expected) << "method " << k << ", step " << step;
        ASSERT_EQ(found_by(compared[k], boxes, kinds), expected) << "method " << k << ", step " << step;
        ASSERT_EQ(found_by(of_spheres[k], spheres, kinds, dirty), expected_of_spheres)
            << "method " << k << ", step " << step;
      }
    }
  }
}

TEST(BroadPhaseKinds, NoticesAChangeOfKindsAlone) {
  const std::vector<Aabb> boxes(3, box_around({0, 0, 0}, {1, 1, 1}));
  const std::vector<std::uint32_t> nothing, second{1};
  for (const BroadPhaseMethod method : test::all_methods) {
    BroadPhase broad_phase(options_of(method, {{0, 2}}));
    using Pairs = std::vector<IndexPair>;
    EXPECT_EQ(found_by(broad_phase, boxes, {0, 1, 2}), (Pairs{{0, 2}}));
    EXPECT_EQ(found_by(broad_phase, boxes, {0, 2, 2}), (Pairs{{0, 1}, {0, 2}}));
    EXPECT_EQ(broad_phase.stats().objects_changed, 1u);
    EXPECT_EQ(found_by(broad_phase, boxes, {0, 2, 2}), (Pairs{{0, 1}, {0, 2}}));
    EXPECT_EQ(broad_phase.stats().objects_changed, 0u);
    EXPECT_EQ(found_by(broad_phase, boxes, {0, 0, 2}, nothing), (Pairs{{0, 1}, {0, 2}}));
    EXPECT_EQ(found_by(broad_phase, boxes, {0, 0, 2}, second), (Pairs{{0, 2}, {1, 2}}));
    EXPECT_EQ(found_by(broad_phase, boxes, {7, 7, 7}), Pairs{});
    EXPECT_EQ(found_by(broad_phase, boxes, {2, 7, 0}), (Pairs{{0, 2}}));
  }
}

TEST(BroadPhaseKinds, TheGridDoesNotTestUnwantedPairs) {
  // All boxes are in one cell, so the grid tests all pairs that it does not exclude by their kinds.
  const std::vector<Aabb> boxes(100, box_around({1, 2, 3}, {1, 1, 1}));
  Random random(5);
  const Kinds kinds = random_kinds(boxes.size(), random);
  for (const KindPairs& wanted : tables) {
    BroadPhase broad_phase(options_of(BroadPhaseMethod::grid, wanted));
    EXPECT_EQ(found_by(broad_phase, boxes, kinds).size(), broad_phase.stats().object_pairs_tested);
  }
}

TEST(BroadPhaseKinds, AreEqualForEveryInstructionSetAndNumberOfThreads) {
  Random random(7);
  // Large enough for several levels of the grid and several chunks of each thread.
  const std::vector<Aabb> boxes = test::clustered_boxes(9000, 8);
  const Kinds kinds = random_kinds(boxes.size(), random);
  for (const KindPairs& wanted : tables) {
    const auto expected = expected_pairs(boxes, kinds, wanted);
    for (const BroadPhaseMethod method : test::all_methods) {
      std::uint64_t tests = 0;
      const auto run = [&](std::uint32_t threads) {
        BroadPhase broad_phase(options_of(method, wanted, threads));
        EXPECT_TRUE(found_by(broad_phase, boxes, kinds) == expected);
        if (tests == 0) tests = broad_phase.stats().object_pairs_tested;
        EXPECT_EQ(broad_phase.stats().object_pairs_tested, tests);
      };
      for (const std::uint32_t threads : {1u, 3u}) run(threads);
      for_each_target([&](const char*) { run(1); });
    }
  }
}

TEST(BroadPhaseKinds, RefusesWrongKinds) {
  const std::vector<Aabb> boxes = test::random_boxes(4, 1, 1, 9);
  EXPECT_THROW(BroadPhase({.kind_pairs = {{0, 8}}}), Error);
  EXPECT_THROW(BroadPhase({.kind_pairs = {{255, 0}}}), Error);
  BroadPhase with_kinds({.kind_pairs = {{0, 1}}}), without;
  EXPECT_THROW(with_kinds.find_object_pairs(boxes), Error);
  EXPECT_THROW(with_kinds.find_object_pairs(boxes, Kinds{0, 1, 2}), Error);
  EXPECT_THROW(with_kinds.find_object_pairs(boxes, Kinds{0, 1, 2, 8}), Error);
  EXPECT_THROW(with_kinds.find_object_pairs(boxes, Kinds{0, 1, 2, 3}, std::vector<std::uint32_t>{4}), Error);
  EXPECT_THROW(without.find_object_pairs(boxes, Kinds{0, 0, 0, 0}), Error);
  try {
    with_kinds.find_object_pairs(boxes, Kinds{0, 1, 9, 3});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "broad phase: volume 2 has the kind 9; kinds are below 8");
  }
  EXPECT_EQ(found_by(with_kinds, boxes, {0, 0, 1, 1}), expected_pairs(boxes, {0, 0, 1, 1}, {{0, 1}}));
}

}  // namespace supple::kinds_test
