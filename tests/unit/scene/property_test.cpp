#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "supple/inspection.hpp"
#include "support/golden_scenes.hpp"
#include "support/instruction_sets.hpp"

namespace supple {
namespace {

class SceneProperties : public testing::TestWithParam<Family> {};

TEST_P(SceneProperties, DetectEqualsExactBruteForceInEveryConfiguration) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const std::vector<TriangleMesh> meshes = GetParam().make(seed);
    Scene reference = scene_of(meshes, {.threads = 1});
    const std::uint64_t hash = hash_of(reference.detect());
    ASSERT_GT(reference.result().contacts.size(), 0u);
    ASSERT_EQ(differences(reference), "") << "seed " << seed;
    ASSERT_EQ(SceneInspector(reference).validate(), "");
    for (const BoundingVolume volume : all_bounding_volumes) {
      for (const BroadPhaseMethod method :
           {BroadPhaseMethod::automatic, BroadPhaseMethod::octree, BroadPhaseMethod::grid,
            BroadPhaseMethod::sweep, BroadPhaseMethod::brute}) {
        for (const std::uint32_t threads : {1u, 2u, 3u, 8u}) {
          Scene scene =
              scene_of(meshes, {.bounding_volume = volume, .broad_phase = method, .threads = threads});
          const DetectResult& result = scene.detect();
          ASSERT_TRUE(std::equal(result.contacts.begin(), result.contacts.end(),
                                 reference.result().contacts.begin(), reference.result().contacts.end()));
          ASSERT_EQ(SceneInspector(scene).validate(), "");
          if (volume == BoundingVolume::aabb) {
            ASSERT_EQ(hash_of(result), hash) << threads;
          }
        }
      }
    }
  }
}

TEST_P(SceneProperties, TreesOfAnyArityGiveTheSameContacts) {
  const std::vector<TriangleMesh> meshes = GetParam().make(5);
  Scene reference = scene_of(meshes, {.threads = 1});
  const std::uint64_t hash = hash_of(reference.detect());
  for (const BoundingVolume volume : all_bounding_volumes) {
    for (const std::uint32_t arity : {2u, 4u}) {
      Scene scene = scene_of(
          meshes, {.bounding_volume = volume, .scene_octree = {.arity = arity}, .threads = 2}, arity);
      const DetectResult& result = scene.detect();
      ASSERT_TRUE(std::equal(result.contacts.begin(), result.contacts.end(),
                             reference.result().contacts.begin(), reference.result().contacts.end()))
          << arity;
      if (volume == BoundingVolume::aabb) {
        ASSERT_EQ(hash_of(result), hash) << arity;
      }
      ASSERT_EQ(SceneInspector(scene).validate(), "");
    }
  }
}

TEST_P(SceneProperties, EveryBuildAndFitGivesTheSameContacts) {
  const std::vector<TriangleMesh> meshes = GetParam().make(8);
  Scene reference = scene_of(meshes, {.threads = 1});
  reference.detect();
  ASSERT_EQ(differences(reference), "");
  for (const auto build :
       {ObjectOctreeBuild::balanced, ObjectOctreeBuild::regular, ObjectOctreeBuild::bottom_up}) {
    for (const std::uint32_t arity : {2u, 4u, 8u}) {
      for (const std::uint32_t leaf_size : {1u, 7u, 64u}) {
        for (const auto& [volume, fit] : {std::pair{BoundingVolume::aabb, SphereFit::vertices},
                                          {BoundingVolume::sphere, SphereFit::vertices},
                                          {BoundingVolume::sphere, SphereFit::minimal}}) {
          Scene scene({.bounding_volume = volume, .threads = 2, .comparison = {.sphere_fit = fit}});
          for (const TriangleMesh& mesh : meshes) {
            scene.add(mesh, {.self_collision = true,
                             .octree = {.leaf_size = leaf_size, .arity = arity, .build = build}});
          }
          const DetectResult& result = scene.detect();
          ASSERT_TRUE(std::ranges::equal(result.contacts, reference.result().contacts));
          ASSERT_TRUE(std::ranges::equal(result.contact_points, reference.result().contact_points));
          ASSERT_EQ(SceneInspector(scene).validate(), "");
        }
      }
    }
  }
}

TEST(SceneGoldenHash, IsTheSameForAnyNumberOfThreads) {
  for (std::uint32_t threads = 1; threads <= 8; ++threads) {
    EXPECT_EQ(hash_of_all_families(threads), golden_hash) << threads;
    EXPECT_EQ(continuous_hash_of_all_families(threads), golden_continuous_hash) << threads;
    EXPECT_EQ(normal_hash_of_all_families(threads), golden_normal_hash) << threads;
  }
}

TEST(SceneGoldenHash, IsTheSameForEveryInstructionSet) {
  int targets = 0;
  for_each_target([&](const char* target) {
    EXPECT_EQ(hash_of_all_families(1), golden_hash) << target;
    EXPECT_EQ(continuous_hash_of_all_families(1), golden_continuous_hash) << target;
    EXPECT_EQ(normal_hash_of_all_families(1), golden_normal_hash) << target;
    ++targets;
  });
  EXPECT_GE(targets, 1);
}

/// Compares not only the contacts but also the number of all volume tests.
TEST(SceneGoldenHash, EveryInstructionSetTestsTheSameVolumes) {
  for (const Family& family : hard_families()) {
    const std::vector<TriangleMesh> meshes = family.make(4);
    Scene reference = scene_of(meshes, {.threads = 1});
    const StepStats expected = reference.detect().stats;
    for_each_target([&](const char* target) {
      Scene scene = scene_of(meshes, {.threads = 1});
      const StepStats& stats = scene.detect().stats;
      EXPECT_EQ(stats.node_pairs_visited, expected.node_pairs_visited) << family.name << ' ' << target;
      EXPECT_EQ(stats.boxes_tested, expected.boxes_tested) << family.name << ' ' << target;
      EXPECT_EQ(stats.candidate_pairs, expected.candidate_pairs) << family.name << ' ' << target;
      EXPECT_EQ(SceneInspector(scene).validate(), "") << family.name << ' ' << target;
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Families, SceneProperties, testing::ValuesIn(hard_families()),
                         [](const auto& family) { return family.param.name; });

}  // namespace
}  // namespace supple
