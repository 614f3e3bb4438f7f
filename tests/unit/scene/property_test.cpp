#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "supple/inspection.hpp"
#include "support/configurations.hpp"
#include "support/golden_scenes.hpp"
#include "support/instruction_sets.hpp"
#include "support/random.hpp"

namespace supple::property_test {

class SceneProperties : public testing::TestWithParam<Family> {};

TEST_P(SceneProperties, EveryConfigurationEqualsExactBruteForce) {
  const std::vector<TriangleMesh> meshes = GetParam().make(1);
  std::vector<Contact> contacts;
  std::vector<ContactPoint> points;
  for (const Configuration& configuration : all_configurations()) {
    SCOPED_TRACE(configuration.name());
    Scene scene(configuration.scene);
    for (const TriangleMesh& mesh : meshes)
      scene.add(mesh, {.self_collision = true, .octree = configuration.octree});
    const DetectResult& result = scene.detect();
    ASSERT_EQ(SceneInspector(scene).validate(), "");
    if (contacts.empty()) {
      ASSERT_EQ(differences(scene), "");
      contacts.assign(result.contacts.begin(), result.contacts.end());
      points.assign(result.contact_points.begin(), result.contact_points.end());
      ASSERT_GT(contacts.size(), 0u);
    }
    ASSERT_TRUE(std::ranges::equal(result.contacts, contacts));
    ASSERT_TRUE(std::ranges::equal(result.contact_points, points));
  }
}

TEST_P(SceneProperties, AnyNumberOfThreadsGivesTheSameBits) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const std::vector<TriangleMesh> meshes = GetParam().make(seed);
    Scene reference = scene_of(meshes, {.threads = 1});
    const std::uint64_t hash = hash_of(reference.detect());
    ASSERT_EQ(differences(reference), "") << "seed " << seed;
    for (const BroadPhaseMethod method :
         {BroadPhaseMethod::automatic, BroadPhaseMethod::octree, BroadPhaseMethod::grid,
          BroadPhaseMethod::sweep, BroadPhaseMethod::brute, BroadPhaseMethod::sweep3}) {
      for (const std::uint32_t threads : {1u, 2u, 3u, 8u}) {
        Scene scene = scene_of(meshes, {.broad_phase = method, .threads = threads});
        ASSERT_EQ(hash_of(scene.detect()), hash) << threads;
      }
    }
  }
}

class OctreeLives : public testing::TestWithParam<EnclosingVolume> {};

/// One object per kind of octree, over 10,000 deformations.
TEST_P(OctreeLives, StayValid) {
  const auto [volume, fit] = GetParam();
  RandomNumbers random(4);
  Scene scene({.bounding_volume = volume,
               .contacts = ContactKinds::none,
               .threads = 1,
               .comparison = {.sphere_fit = fit}});
  const TriangleMesh mesh = crumpled_sheet(3, 4, 0.2, 1);
  std::vector<ObjectId> ids;
  for (ObjectOctreeOptions octree : all_octrees()) {
    octree.leaf_size = 1 + random.below(4);
    ids.push_back(scene.add(mesh, {.octree = octree}));
  }
  std::vector<std::vector<Vec3d>> positions(ids.size(), mesh.positions);
  for (int step = 0; step < 10'000; ++step) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      // Small steps that add up to large deformations, and now and then a new start.
      for (Vec3d& p : positions[i]) p = p + random.vector(0.05);
      if (random.below(500) == 0) positions[i] = mesh.positions;
      scene.set_positions(ids[i], positions[i]);
    }
    scene.detect();
    if (step % 5 == 0) {
      ASSERT_EQ(SceneInspector(scene).validate(), "") << "step " << step;
    }
  }
}

std::string volume_name(const testing::TestParamInfo<OctreeLives::ParamType>& info) {
  constexpr std::array fits{"", "Minimal", "Medial"};
  return name_of(info.param.first) + fits[static_cast<std::size_t>(info.param.second.value)];
}

INSTANTIATE_TEST_SUITE_P(Volumes, OctreeLives, testing::ValuesIn(all_enclosing_volumes()), volume_name);

void expect_golden_hashes(std::uint32_t threads, const char* target) {
  for (const GoldenHash& golden : golden_scene_hashes)
    EXPECT_EQ(golden.compute(threads), golden.value)
        << golden.part << ", " << threads << " threads, " << target;
}

TEST(SceneGoldenHash, IsTheSameForAnyNumberOfThreads) {
  for (const std::uint32_t threads : {1u, 2u, 3u, 8u}) expect_golden_hashes(threads, "best instruction set");
}

TEST(SceneGoldenHash, IsTheSameForEveryInstructionSet) {
  int targets = 0;
  for_each_target([&](const char* target) {
    expect_golden_hashes(1, target);
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

}  // namespace supple::property_test
