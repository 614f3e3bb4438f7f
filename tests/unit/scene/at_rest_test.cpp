#include <gtest/gtest.h>

#include <stdexcept>
#include <tuple>
#include <vector>

#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/option_word.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace supple::at_rest_test {

/// Spheres; in each step some of them move and the others are at rest.
struct World {
  explicit World(const SceneOptions& options) : scene(options) {
    for (int i = 0; i < 8; ++i) {
      centers.push_back({1.7 * (i & 1), 1.7 * (i >> 1 & 1), 1.7 * (i >> 2)});
      ids.push_back(scene.add(positions_of(i), mesh.triangles, {.self_collision = i == 3}));
    }
  }
  std::vector<Vec3d> positions_of(int i) const {
    std::vector<Vec3d> positions;
    for (const Vec3d& p : mesh.positions) positions.push_back(p + centers[static_cast<std::size_t>(i)]);
    return positions;
  }

  TriangleMesh mesh = make_icosphere(6);
  std::vector<Vec3d> centers;
  Scene scene;
  std::vector<ObjectId> ids;
};

/// Compares the result with that of a new scene.
void expect_as_new(const World& world, const DetectResult& result, const SceneOptions& options) {
  World fresh(options);
  fresh.centers = world.centers;
  for (int i = 0; i < 8; ++i)
    fresh.scene.set_positions(fresh.ids[static_cast<std::size_t>(i)], fresh.positions_of(i));
  const DetectResult& expected = fresh.scene.detect();
  ASSERT_EQ(result.contacts.size(), expected.contacts.size());
  ASSERT_EQ(result.groups.size(), expected.groups.size());
  ASSERT_EQ(result.contact_points.size(), expected.contact_points.size());
  EXPECT_EQ(result.stats.contacts, expected.stats.contacts);
  for (std::size_t i = 0; i < result.groups.size(); ++i) {
    EXPECT_EQ(result.groups[i].a.index, expected.groups[i].a.index);
    EXPECT_EQ(result.groups[i].b.index, expected.groups[i].b.index);
    EXPECT_EQ(result.groups[i].first_contact, expected.groups[i].first_contact);
    EXPECT_EQ(result.groups[i].contact_count, expected.groups[i].contact_count);
  }
  for (std::size_t i = 0; i < result.contacts.size(); ++i) {
    const Contact &found = result.contacts[i], &truth = expected.contacts[i];
    EXPECT_EQ(found.object_a.index, truth.object_a.index);
    EXPECT_EQ(found.object_b.index, truth.object_b.index);
    EXPECT_EQ(found.triangle_a, truth.triangle_a);
    EXPECT_EQ(found.triangle_b, truth.triangle_b);
    EXPECT_EQ(found.kind, truth.kind);
    EXPECT_EQ(found.point_count, truth.point_count);
    EXPECT_EQ(found.triangle_b, truth.triangle_b);
    EXPECT_EQ(found.first_point, truth.first_point);
  }
  for (std::size_t i = 0; i < result.contact_points.size(); ++i)
    EXPECT_EQ(result.contact_points[i], expected.contact_points[i]);
}

class AtRest : public ::testing::TestWithParam<std::tuple<OptionWord<BoundingVolume>, std::uint32_t, bool>> {
};
INSTANTIATE_TEST_SUITE_P(All, AtRest,
                         ::testing::Combine(::testing::ValuesIn(option_words(all_bounding_volumes)),
                                            ::testing::Values(1u, 3u), ::testing::Bool()));

TEST_P(AtRest, ContactsAreThoseOfASceneWithoutAPast) {
  SceneOptions options;
  std::tie(options.bounding_volume, options.threads, options.contact_points) = GetParam();
  World world(options);
  RandomNumbers random(5);
  for (int step = 0; step < 12; ++step) {
    for (int i = 0; i < 8; ++i) {
      if (random.below(3) != 0) continue;
      const auto at = static_cast<std::size_t>(i);
      world.centers[at].x += random.between(-32, 31) / 128.0;
      world.scene.set_positions(world.ids[at], world.positions_of(i));
    }
    expect_as_new(world, world.scene.detect(), options);
    EXPECT_EQ(SceneInspector(world.scene).validate(), "");
  }
  EXPECT_TRUE(verify(world.scene).agrees());
}

TEST(AtRestScene, WhatWasDoneIsNotDoneAgain) {
  World world({.threads = 1});
  const StepStats first = world.scene.detect().stats;
  EXPECT_GT(first.candidate_pairs, 0u);
  const StepStats second = world.scene.detect().stats;
  EXPECT_EQ(second.candidate_pairs, 0u);
  EXPECT_EQ(second.contacts, first.contacts);
  world.scene.translate(world.ids[0], {0.01, 0, 0});
  const StepStats third = world.scene.detect().stats;
  EXPECT_GT(third.candidate_pairs, 0u);
  EXPECT_LT(third.candidate_pairs, first.candidate_pairs / 2);
}

TEST(AtRestScene, PairsThatComeBackAreLookedAtAgain) {
  const SceneOptions options{.threads = 1};
  World world(options);
  const std::size_t all = world.scene.detect().contacts.size();
  world.scene.set_pair_filter([](ObjectId, ObjectId) { return false; });
  EXPECT_LT(world.scene.detect().contacts.size(), all);
  world.scene.set_pair_filter({});
  expect_as_new(world, world.scene.detect(), options);
}

TEST(AtRestScene, AnotherObjectInTheSamePlaceIsAnother) {
  World world({.threads = 1});
  world.scene.detect();
  world.scene.remove(world.ids[7]);
  world.ids[7] = world.scene.add(world.positions_of(0), world.mesh.triangles);
  ASSERT_EQ(world.ids[7].index, 7u);
  world.scene.detect();
  EXPECT_TRUE(verify(world.scene).agrees());
}

TEST(AtRestScene, AStepThatWasLeftByAnExceptionLeavesNothingBehind) {
  const SceneOptions options{.threads = 1};
  World world(options);
  world.scene.detect();
  world.centers[1].x -= 0.3;
  world.scene.set_positions(world.ids[1], world.positions_of(1));
  world.scene.set_pair_filter([](ObjectId, ObjectId) -> bool { throw std::runtime_error("no"); });
  EXPECT_THROW(world.scene.detect(), std::runtime_error);
  world.scene.set_pair_filter({});
  expect_as_new(world, world.scene.detect(), options);
}

}  // namespace supple::at_rest_test
