#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "supple/error.hpp"
#include "support/soups.hpp"
#include "unit/recording/recorded_scenes.hpp"

namespace supple {
namespace {

Contents touching(ContactKinds mode, bool colliding_vertices = false) {
  ObjectOptions free, fixed;
  free.margin = fixed.margin = 0.05;
  fixed.is_static = true;
  SceneOptions scene;
  scene.contacts = mode;
  scene.threads = 1;
  scene.comparison.colliding_vertices = colliding_vertices;
  return simulate({random_soup(30, 1, 0.6, 4), random_soup(20, 1, 0.6, 5), random_soup(20, 1, 0.6, 6)},
                  {free, free, fixed}, scene, 4);
}

/// Compares `base_` with a copy that `change` has modified.
class FindFirstDifference : public testing::TestWithParam<ContactKinds> {
 protected:
  std::optional<RecordingDifference> after(const std::function<void(Contents&)>& change,
                                           double tolerance = 0) const {
    Contents changed = base_;
    change(changed);
    const TemporaryFolder folder;
    base_.write(folder / "a.h5");
    changed.write(folder / "b.h5");
    return find_first_difference(Recording(folder / "a.h5"), Recording(folder / "b.h5"), tolerance);
  }
  void expect(std::optional<std::uint64_t> frame, const std::string& what,
              const std::function<void(Contents&)>& change) const {
    const std::optional<RecordingDifference> difference = after(change);
    ASSERT_TRUE(difference) << what;
    EXPECT_EQ(difference->frame, frame) << difference->what;
    EXPECT_EQ(difference->what.find(what), 0u) << difference->what << "\nnot " << what;
    EXPECT_EQ(difference->what.find('\n'), std::string::npos);
  }

  Contents base_ = touching(GetParam());
};
using InEveryMode = FindFirstDifference;
using OfIntersections = FindFirstDifference;
using OfContinuousContacts = FindFirstDifference;
using OfProximity = FindFirstDifference;

TEST_P(InEveryMode, NothingWhenEqual) {
  EXPECT_FALSE(after([](Contents&) {}));
}

TEST_P(InEveryMode, NotWhatIsMeasuredOrOfTheFile) {
  EXPECT_FALSE(after([](Contents& c) {
    c.header.scene_file = "other";
    StepStats& stats = c.frames[1].stats;
    stats.refit_seconds = stats.broad_phase_seconds = stats.traversal_seconds = stats.exact_seconds =
        stats.sort_and_events_seconds = stats.total_seconds = 9;
    stats.node_pairs_visited += 1;
    stats.boxes_tested += 1;
  }));
}

TEST_P(InEveryMode, WhatIsSaidOnce) {
  expect({}, "time_step: 0.1 and 0.2", [](Contents& c) { c.header.time_step = 0.2; });
  expect({}, "broad_phase: 'automatic' and 'brute'",
         [](Contents& c) { c.header.scene.broad_phase = BroadPhaseMethod::brute; });
  expect({}, "min_separation: 0 and 0.5", [](Contents& c) { c.header.scene.impact.min_separation = 0.5; });
  expect({}, "name of object 1: 'object 1' and 'fish'",
         [](Contents& c) { c.header.objects[1].options.name = "fish"; });
  expect({}, "mask of object 2: 4294967295 and 5", [](Contents& c) { c.header.objects[2].options.mask = 5; });
  expect({}, "triangle 3 of object 0: (9, 10, 11) and (9, 10, 2)",
         [](Contents& c) { c.header.objects[0].triangles[3][2] = 2; });
  expect({}, "number of edges of object 0: 0 and 1", [](Contents& c) {
    c.header.objects[0].options.edges = {{1, 2}};
  });
  expect({}, "number of points of object 1: 0 and 1",
         [](Contents& c) { c.header.objects[1].options.points = {4}; });
  expect({}, "rest position of vertex 6 of object 0: ", [](Contents& c) {
    c.header.objects[0].rest_positions[6].y += 1;
  });
  expect({}, "number of objects: 3 and 4", [](Contents& c) {
    c.header.objects.push_back({ObjectId{9, 0}, {}, {}, {}});
    for (auto& frame : c.positions) frame.emplace_back();
  });
  expect({}, "number of frames: 4 and 3", [](Contents& c) {
    c.frames.pop_back();
    c.positions.pop_back();
  });
}

TEST_P(InEveryMode, TimesPositionsAndPairs) {
  expect(2, "time: 0.2 and 0.25", [](Contents& c) { c.frames[2].time = 0.25; });
  expect(1, "position of vertex 5 of object 1 'object 1': (", [](Contents& c) {
    c.positions[1][1][5].z = std::nextafter(c.positions[1][1][5].z, 9);
    c.positions[3][0][0].x = 7;
  });
  expect(0, "position of vertex 0 of object 2 'object 2': (", [](Contents& c) {
    for (auto& frame : c.positions) frame[2][0].x += 1;
  });
  ASSERT_EQ(base_.frames[0].object_pairs.size(), 3u);
  expect(0,
         "object pair 1: object 0 'object 0' and object 2 'object 2' only in the first recording (3 and 2 in "
         "all)",
         [](Contents& c) { c.frames[0].object_pairs.erase(c.frames[0].object_pairs.begin() + 1); });
  expect(3, "event volume_begin 0: object 0 'object 0' and object 1 'object 1' only in the second",
         [](Contents& c) {
           c.frames[3].volume_begin = {{c.header.objects[0].id, c.header.objects[1].id}};
         });
  for (const auto& [name, pairs] : {std::pair{"event volume_end", &RecordedFrame::volume_end},
                                    std::pair{"event narrow_phase_begin", &RecordedFrame::narrow_phase_begin},
                                    std::pair{"event narrow_phase_end", &RecordedFrame::narrow_phase_end},
                                    std::pair{"event contact_begin", &RecordedFrame::contact_begin},
                                    std::pair{"event contact_end", &RecordedFrame::contact_end},
                                    std::pair{"event proximity_begin", &RecordedFrame::proximity_begin},
                                    std::pair{"event proximity_end", &RecordedFrame::proximity_end}}) {
    auto member = pairs;
    expect(3, name, [member](Contents& c) {
      (c.frames[3].*member).push_back({c.header.objects[1].id, c.header.objects[2].id});
    });
  }
  expect(2, "statistics, contacts: ", [](Contents& c) { ++c.frames[2].stats.contacts; });
  expect(1, "statistics, candidate_pairs: ", [](Contents& c) { ++c.frames[1].stats.candidate_pairs; });
}

TEST_P(InEveryMode, NumbersByBitsOrTolerance) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(after([](Contents& c) { c.positions[1][0][0].x += 1e-12; }));
  EXPECT_FALSE(after([](Contents& c) { c.positions[1][0][0].x += 1e-12; }, 1e-11));
  EXPECT_TRUE(after([](Contents& c) { c.positions[1][0][0].x += 1e-10; }, 1e-11));
  EXPECT_TRUE(after([nan](Contents& c) { c.positions[1][0][0].x = nan; }, 1e300));
  base_.positions[1][0][0].x = nan;
  EXPECT_FALSE(after([](Contents&) {}));
  EXPECT_TRUE(after([nan](Contents& c) { c.positions[1][0][0].x = -nan; }));
  EXPECT_FALSE(after([nan](Contents& c) { c.positions[1][0][0].x = -nan; }, 1e-300));
  base_.positions[1][0][0].x = 0;
  EXPECT_TRUE(after([](Contents& c) { c.positions[1][0][0].x = -0.0; }));
}

TEST_P(InEveryMode, RefusesAToleranceThatIsNone) {
  for (const double tolerance : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(after([](Contents&) {}, tolerance), Error);
}

INSTANTIATE_TEST_SUITE_P(, InEveryMode, testing::Values(ContactKinds::intersection));

TEST_P(OfIntersections, Contacts) {
  ASSERT_GT(base_.frames[1].contacts.size(), 3u);
  expect(1, "contact 2: triangle ",
         [](Contents& c) { c.frames[1].contacts.erase(c.frames[1].contacts.begin() + 2); });
  expect(1, "contact 2, triangle ", [](Contents& c) {
    Contact& contact = c.frames[1].contacts[2];
    contact.kind =
        contact.kind == IntersectionKind::point ? IntersectionKind::segment : IntersectionKind::point;
  });
  expect(1, "contact 2, triangle ", [](Contents& c) { c.frames[1].contacts[2].normal.x += 1e-9; });
  EXPECT_FALSE(after([](Contents& c) { c.frames[1].contacts[2].normal.x += 1e-9; }, 1e-8));
  const std::optional<RecordingDifference> missing =
      after([](Contents& c) { c.frames[1].contacts.erase(c.frames[1].contacts.begin() + 2); });
  EXPECT_NE(missing->what.find("only in the first"), std::string::npos) << missing->what;
  expect(2, "contact point 1, position: (",
         [](Contents& c) { c.frames[2].contact_points[1].position.x += 1e-9; });
  expect(2, "contact point 1, feature_b: ", [](Contents& c) {
    FeatureKind& kind = c.frames[2].contact_points[1].on_b.kind;
    kind = kind == FeatureKind::face ? FeatureKind::edge : FeatureKind::face;
  });
  expect(2, "number of contact points: ", [](Contents& c) { c.frames[2].contact_points.push_back({}); });
  EXPECT_FALSE(after([](Contents& c) { c.frames[2].contact_points[1].position.x += 1e-9; }, 1e-8));
}

TEST_P(OfIntersections, CollidingVertices) {
  base_ = touching(GetParam(), true);
  ASSERT_GT(base_.frames[1].colliding_vertex_groups.size(), 1u);
  const std::string pair = "colliding vertices 1, object 0 'object 0' and object 2 'object 2', ";
  expect(1, pair + "vertex 0: ", [](Contents& c) {
    RecordedFrame& frame = c.frames[1];
    frame.colliding_vertices[frame.colliding_vertex_groups[1].first_vertex] += 1;
  });
  expect(1, pair + "count_b: ", [](Contents& c) { --c.frames[1].colliding_vertex_groups[1].count_b; });
  expect(2, "colliding vertices 0: object 0 'object 0' and object 1 'object 1' only in the first",
         [](Contents& c) {
           auto& groups = c.frames[2].colliding_vertex_groups;
           groups.erase(groups.begin());
         });
}
INSTANTIATE_TEST_SUITE_P(, OfIntersections, testing::Values(ContactKinds::intersection));

TEST_P(OfContinuousContacts, EveryField) {
  ASSERT_GT(base_.frames[2].continuous_contacts.size(), 1u);
  const auto change = [this](const char* field, const std::function<void(ContinuousContact&)>& function) {
    const std::optional<RecordingDifference> difference =
        after([&](Contents& c) { function(c.frames[2].continuous_contacts[1]); });
    ASSERT_TRUE(difference) << field;
    EXPECT_EQ(difference->frame, 2u);
    EXPECT_EQ(difference->what.find("continuous contact 1, "), 0u) << difference->what;
    EXPECT_NE(difference->what.find(std::string(", ") + field + ": "), std::string::npos) << difference->what;
  };
  change("certainty", [](ContinuousContact& c) { c.certainty = ImpactCertainty::within_tolerance; });
  change("touching_at_start", [](ContinuousContact& c) { c.touching_at_start = !c.touching_at_start; });
  change("toi", [](ContinuousContact& c) { c.toi += 1e-3; });
  change("start_distance", [](ContinuousContact& c) { c.start_distance += 1e-3; });
  change("barycentric_a", [](ContinuousContact& c) { c.barycentric_a[1] += 1e-3; });
  change("barycentric_b", [](ContinuousContact& c) { c.barycentric_b[2] += 1e-3; });
  change("point", [](ContinuousContact& c) { c.point.y += 1e-3; });
  change("normal", [](ContinuousContact& c) { c.normal.z += 1e-3; });
  expect(2, "continuous contact 0: ", [](Contents& c) {
    c.frames[2].continuous_contacts.erase(c.frames[2].continuous_contacts.begin());
  });
}
INSTANTIATE_TEST_SUITE_P(, OfContinuousContacts, testing::Values(ContactKinds::continuous));

TEST_P(OfProximity, EveryField) {
  ASSERT_GT(base_.frames[2].proximity_pairs.size(), 1u);
  const auto change = [this](const char* field, const std::function<void(ProximityPair&)>& function) {
    const std::optional<RecordingDifference> difference =
        after([&](Contents& c) { function(c.frames[2].proximity_pairs[1]); });
    ASSERT_TRUE(difference) << field;
    EXPECT_EQ(difference->frame, 2u);
    EXPECT_EQ(difference->what.find("proximity pair 1, "), 0u) << difference->what;
    EXPECT_NE(difference->what.find(std::string(", ") + field + ": "), std::string::npos) << difference->what;
  };
  const auto other = [](FeatureKind kind) {
    return kind == FeatureKind::edge ? FeatureKind::vertex : FeatureKind::edge;
  };
  change("feature_a", [&](ProximityPair& p) { p.on_a.kind = other(p.on_a.kind); });
  change("feature_index_a", [](ProximityPair& p) { p.on_a.index = p.on_a.index == 1 ? 0 : 1; });
  change("feature_b", [&](ProximityPair& p) { p.on_b.kind = other(p.on_b.kind); });
  change("feature_index_b", [](ProximityPair& p) { p.on_b.index = p.on_b.index == 1 ? 0 : 1; });
  change("distance", [](ProximityPair& p) { p.distance += 1e-3; });
  change("barycentric_a", [](ProximityPair& p) { p.barycentric_a[1] += 1e-3; });
  change("barycentric_b", [](ProximityPair& p) { p.barycentric_b[2] += 1e-3; });
  change("point_a", [](ProximityPair& p) { p.point_a.y += 1e-3; });
  change("point_b", [](ProximityPair& p) { p.point_b.y += 1e-3; });
  change("normal", [](ProximityPair& p) { p.normal.z += 1e-3; });
  expect(2, "proximity pair 0: ", [](Contents& c) {
    c.frames[2].proximity_pairs.erase(c.frames[2].proximity_pairs.begin());
  });
}
INSTANTIATE_TEST_SUITE_P(, OfProximity, testing::Values(ContactKinds::proximity));

}  // namespace
}  // namespace supple
