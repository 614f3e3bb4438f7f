#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "supple/error.hpp"
#include "support/option_word.hpp"
#include "support/soups.hpp"
#include "unit/recording/recorded_scenes.hpp"

namespace supple::difference_test {

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
class FindFirstDifference : public testing::TestWithParam<OptionWord<ContactKinds>> {
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

TEST_P(InEveryMode, CountsOfWorkOnlyOfAsManyRanks) {
  const auto change = [](std::uint32_t ranks) {
    return [ranks](Contents& c) {
      c.header.ranks = ranks;
      c.frames[1].stats.object_pairs_tested += 1;
    };
  };
  EXPECT_FALSE(after(change(3)));
  expect(1, "statistics, object_pairs_tested", change(1));
  expect(2, "time: ", [&](Contents& c) {
    change(3)(c);
    c.frames[2].time += 1;
  });
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
           c.frames[3].volume_events.begin = {{c.header.objects[0].id, c.header.objects[1].id}};
         });
  const auto add_pair = [](RecordedEvents RecordedFrame::*events, bool at_end) {
    return [=](Contents& c) {
      RecordedEvents& of = c.frames[3].*events;
      (at_end ? of.end : of.begin).push_back({c.header.objects[1].id, c.header.objects[2].id});
    };
  };
  expect(3, "event volume_end", add_pair(&RecordedFrame::volume_events, true));
  for (const auto& [name, events] : {std::pair{"narrow_phase", &RecordedFrame::narrow_phase_events},
                                     std::pair{"contact", &RecordedFrame::contact_events},
                                     std::pair{"proximity", &RecordedFrame::proximity_events},
                                     std::pair{"penetration", &RecordedFrame::penetration_events}}) {
    expect(3, std::string("event ") + name + "_begin", add_pair(events, false));
    expect(3, std::string("event ") + name + "_end", add_pair(events, true));
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

class OfPenetration : public FindFirstDifference {
 protected:
  OfPenetration() { base_ = simulate_solids(4); }

  /// Expects that the difference names the row and the field.
  template <class Row>
  void change(std::vector<Row> RecordedFrame::*list, std::size_t row, const std::string& item,
              const std::string& field, const std::function<void(Row&)>& function) const {
    ASSERT_GT((base_.frames[2].*list).size(), row) << item;
    const std::optional<RecordingDifference> difference =
        after([&](Contents& c) { function((c.frames[2].*list)[row]); });
    ASSERT_TRUE(difference) << field;
    EXPECT_EQ(difference->frame, 2u);
    EXPECT_EQ(difference->what.find(item), 0u) << difference->what;
    EXPECT_NE(difference->what.find(", " + field + ": "), std::string::npos) << difference->what;
  }
};

TEST_P(OfPenetration, EveryFieldOfPenetrations) {
  const auto change_row = [this](const char* field, const std::function<void(Penetration&)>& function) {
    change<Penetration>(&RecordedFrame::penetrations, 1, "penetration 1, vertex ", field, function);
  };
  change_row("triangle", [](Penetration& p) { p.triangle = p.triangle == 0 ? 1 : 0; });
  change_row("feature", [](Penetration& p) {
    p.feature.kind = p.feature.kind == FeatureKind::edge ? FeatureKind::face : FeatureKind::edge;
  });
  change_row("feature_index", [](Penetration& p) { p.feature.index = p.feature.index == 1 ? 0 : 1; });
  change_row("depth", [](Penetration& p) { p.depth += 1e-3; });
  change_row("barycentric", [](Penetration& p) { p.barycentric[2] += 1e-3; });
  change_row("point", [](Penetration& p) { p.point.y += 1e-3; });
  change_row("normal", [](Penetration& p) { p.normal.z += 1e-3; });
  const Penetration& first = base_.frames[2].penetrations[0];
  expect(2,
         "penetration 0: vertex " + std::to_string(first.vertex) +
             " of object 0 'object 0' and object 1 'object 1' only in the first",
         [](Contents& c) { ++c.frames[2].penetrations[0].vertex; });
  EXPECT_FALSE(after([](Contents& c) { c.frames[2].penetrations[1].depth += 1e-9; }, 1e-8));
}

TEST_P(OfPenetration, EveryFieldOfGroups) {
  const std::vector<PenetrationGroup>& groups = base_.frames[2].penetration_groups;
  std::size_t row = 0;
  while (row < groups.size() && (groups[row].on_surface_count == 0 || groups[row].penetration_count == 0))
    ++row;
  ASSERT_LT(row, groups.size());
  ASSERT_GT(groups[row].first_penetration, 0u);
  const std::string item = "penetration group " + std::to_string(row) + ", object ";
  const auto change_row = [&](const char* field, const std::function<void(PenetrationGroup&)>& function) {
    change<PenetrationGroup>(&RecordedFrame::penetration_groups, row, item, field, function);
  };
  change_row("penetration_count", [](PenetrationGroup& g) { --g.penetration_count; });
  change_row("first_penetration", [](PenetrationGroup& g) { --g.first_penetration; });
  change_row("on_surface_count", [](PenetrationGroup& g) { --g.on_surface_count; });
  expect(2, item, [&](Contents& c) { c.frames[2].vertices_on_surface[groups[row].first_on_surface] += 1; });
  expect(2, "penetration group 0: object 0 'object 0' and object 1 'object 1' only in the first",
         [](Contents& c) { c.frames[2].penetration_groups.erase(c.frames[2].penetration_groups.begin()); });
}

TEST_P(OfPenetration, EveryFieldOfContainedParts) {
  expect(3, "contained part 0, vertex 0 of object 2 'object 2' and object 0 'object 0', vertex_count: ",
         [](Contents& c) { --c.frames[3].contained_parts.at(0).vertex_count; });
  expect(3, "contained part 0, vertex 0 of object 2 'object 2' and object 0 'object 0', is_whole: 1 and 0",
         [](Contents& c) { c.frames[3].contained_parts.at(0).is_whole = false; });
  expect(3, "contained part 0: vertex 0 of object 2 'object 2' and object 0 'object 0' only in the first",
         [](Contents& c) { c.frames[3].contained_parts.clear(); });
}

TEST_P(OfPenetration, EveryFieldOfCurves) {
  const std::vector<IntersectionCurve>& curves = base_.frames[2].curves;
  ASSERT_EQ(curves.at(0).kind, CurveKind::closed);
  ASSERT_GT(curves[0].enclosed_count_a, 0u);
  ASSERT_GT(curves[0].enclosed_count_b, 0u);
  const std::string item = "curve 0, object 0 'object 0' and object 1 'object 1', ";
  const auto change_row = [&](const char* field, const std::function<void(IntersectionCurve&)>& function) {
    change<IntersectionCurve>(&RecordedFrame::curves, 0, item, field, function);
  };
  expect(2, item + "kind: 'closed' and 'open'",
         [](Contents& c) { c.frames[2].curves[0].kind = CurveKind::open; });
  expect(2, item + "contact_count: ", [](Contents& c) { --c.frames[2].curves[0].contact_count; });
  expect(2, item + "point_count: ", [](Contents& c) { --c.frames[2].curves[0].point_count; });
  expect(2, item + "enclosed_count_a: ", [](Contents& c) { --c.frames[2].curves[0].enclosed_count_a; });
  expect(2, item + "enclosed_count_b: ", [](Contents& c) { --c.frames[2].curves[0].enclosed_count_b; });
  expect(2, "curve 1, ", [](Contents& c) { --c.frames[2].curves.at(1).first_contact; });
  expect(2, "curve 1, ", [](Contents& c) { --c.frames[2].curves.at(1).first_point; });
  expect(2, "curve 1, ", [](Contents& c) { --c.frames[2].curves.at(1).first_enclosed; });
  expect(2, item + "contact 3: ", [](Contents& c) { c.frames[2].curve_contacts[3] = 0; });
  expect(2, item + "point 4: (", [](Contents& c) { c.frames[2].curve_points[4].x += 1e-9; });
  expect(2, item + "enclosed vertex 0: ", [](Contents& c) { c.frames[2].enclosed_vertices[0] += 1; });
  change_row("centroid", [](IntersectionCurve& c) { c.centroid.x += 1e-3; });
  change_row("area", [](IntersectionCurve& c) { c.area.y += 1e-3; });
  change_row("normal", [](IntersectionCurve& c) { c.normal.z += 1e-3; });
  change_row("depth", [](IntersectionCurve& c) { c.depth += 1e-3; });
  expect(2, "curve " + std::to_string(curves.size() - 1) + ": object ",
         [](Contents& c) { c.frames[2].curves.pop_back(); });
  EXPECT_FALSE(after(
      [](Contents& c) {
        c.frames[2].curves[0].centroid.x += 1e-9;
        c.frames[2].curve_points[4].x += 1e-9;
      },
      1e-8));
}
INSTANTIATE_TEST_SUITE_P(, OfPenetration, testing::Values(ContactKinds::penetration));

}  // namespace supple::difference_test
