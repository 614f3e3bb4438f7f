// A removed object leaves a free slot, which no list names.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple::free_slots_test {

class FreeSlots : public testing::TestWithParam<std::vector<std::uint32_t>> {
 protected:
  /// Balls in a row that overlap and move against each other, without those of the parameter.
  FreeSlots()
      : scene_({.contacts = ContactKinds::continuous | ContactKinds::proximity | ContactKinds::penetration,
                .impact = {.min_separation = 0.01}}) {
    for (std::uint32_t i = 0; i < 6; ++i) {
      TriangleMesh ball = make_icosphere(3);
      for (Vec3d& p : ball.positions) p.x += 1.5 * i;
      std::vector<Vec3d> to = ball.positions;
      for (Vec3d& p : to) p.x += i % 2 == 0 ? 0.25 : -0.25;
      ids_.push_back(scene_.add(ball, {.margin = 0.1}));
      scene_.set_motion(ids_.back(), ball.positions, to);
    }
  }
  void search_and_remove() {
    search();  // all lists have known these objects
    for (const std::uint32_t i : GetParam()) scene_.remove(ids_[i]);
    left_ = scene_.objects();
    ASSERT_EQ(left_.size(), ids_.size() - GetParam().size());
  }
  void search() {
    scene_.detect();
    scene_.collision_free_steps();
    scene_.distances(10);
  }
  void expect_left(ObjectId id, const char* list) const {
    EXPECT_TRUE(std::ranges::binary_search(left_, id)) << list << " names " << id.index;
  }
  template <class List>
  void expect_pairs_left(const List& list, const char* name) const {
    for (const auto& item : list) {
      expect_left(item.object_a, name);
      expect_left(item.object_b, name);
    }
  }

  Scene scene_;
  std::vector<ObjectId> ids_, left_;
};

TEST_P(FreeSlots, AreInNoListOfSteps) {
  search_and_remove();
  for (const double seconds : {1e3, 0.0}) {
    const StepLimits limits{.seconds = seconds};
    std::vector<ObjectId> listed;
    for (const ObjectStep& step : scene_.collision_free_steps({}, limits)) {
      listed.push_back(step.object);
      expect_left(step.island, "the islands");
      if (step.safe.limit) expect_pairs_left(std::vector{*step.safe.limit}, "a limit");
    }
    EXPECT_EQ(listed, left_);
    for (const SafeStep& step : {scene_.max_step(limits), scene_.collision_free_step({}, limits)}) {
      if (step.limit) expect_pairs_left(std::vector{*step.limit}, "a limit");
    }
  }
}

TEST_P(FreeSlots, AreInNoListOfASearch) {
  search_and_remove();
  const DetectResult& found = scene_.detect();
  const auto expect_groups = [&](const auto& groups, const char* name) {
    for (const auto& group : groups) {
      expect_left(group.a, name);
      expect_left(group.b, name);
    }
  };
  EXPECT_EQ(found.continuous_groups.empty(), left_.size() < 2);
  expect_groups(found.groups, "groups");
  expect_groups(found.continuous_groups, "continuous_groups");
  expect_groups(found.proximity_groups, "proximity_groups");
  expect_groups(found.penetration_groups, "penetration_groups");
  expect_pairs_left(found.continuous_contacts, "continuous_contacts");
  expect_pairs_left(found.proximity_pairs, "proximity_pairs");
  expect_pairs_left(scene_.distances(10), "distances");
  for (const Overlap& overlap : scene_.overlaps(std::vector<QueryBox>{{{-100, -100, -100}, {100, 100, 100}}}))
    expect_left(overlap.object, "overlaps");
  for (const ListedRayHit& hit : scene_.cast_all(std::vector<Ray>{{{-100, 0.1, 0.1}, {1, 0, 0}}}))
    expect_left(hit.hit.object, "cast_all");
}

INSTANTIATE_TEST_SUITE_P(All, FreeSlots,
                         testing::Values(std::vector<std::uint32_t>{0}, std::vector<std::uint32_t>{2, 3},
                                         std::vector<std::uint32_t>{5},
                                         std::vector<std::uint32_t>{0, 1, 2, 4, 5},
                                         std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}),
                         [](const auto& of) {
                           std::string name;
                           for (const std::uint32_t i : of.param) name += std::to_string(i);
                           return "Without" + name;
                         });

}  // namespace supple::free_slots_test
