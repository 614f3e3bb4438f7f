#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "../../support/viewer_page.hpp"

namespace supple::viewer::session_frames_test {

/// A value of the last step's statistics, found by its name.
double statistic(const ViewerMessage& scene, const ViewerMessage& frame, const std::string& name) {
  const auto names = scene.json["statistics"].get<std::vector<std::string>>();
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  const std::vector<double> values = frame.values<double>(43);
  EXPECT_GE(values.size(), names.size());
  EXPECT_EQ(values.size() % names.size(), 0u);
  return values[values.size() - names.size() + static_cast<std::size_t>(found - names.begin())];
}

TEST(ViewerFrames, ShowsWhatTheLibraryFinds) {
  SceneView show = touching_balls();
  Simulation simulation = simulation_of(show);
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  const Vec3d center = center_of(scene);
  std::size_t contacts = 0, last = 0;
  for (std::uint32_t step = 0; step < 80; ++step) {
    if (step > 0) simulation.step();
    const ViewerMessage frame = step == 0 ? page.frame() : page.frame_after_steps(1);
    ASSERT_EQ(frame.json["step"], step);
    const DetectResult& result = simulation.scene().result();
    expect_contacts(frame, result, center);
    EXPECT_EQ(frame.values<Vec3f>(32, 2), as_floats(simulation.positions({2, 0}), center));
    EXPECT_EQ(statistic(scene, frame, "contacts"), static_cast<double>(result.contacts.size()));
    EXPECT_EQ(statistic(scene, frame, "object_pairs"), static_cast<double>(result.object_pairs.size()));
    if (step == 0) contacts = result.contacts.size();
    last = result.contacts.size();
  }
  EXPECT_GT(contacts, 0u);
  EXPECT_GT(last, contacts) << "the third ball has arrived";
}

TEST(ViewerFrames, ProximityPairsPenetrationsAndCurvesAreThoseOfTheLibrary) {
  SceneView show = touching_balls();
  show.simulation.scene.contacts = ContactKinds::proximity | ContactKinds::penetration;
  show.simulation.scene.curves = true;
  for (ViewedObject& object : show.objects) {
    object.options.margin = 0.02;
    object.options.solid = true;
  }
  Simulation simulation = simulation_of(show);
  const DetectResult& expected = simulation.detect();
  TestPage page(show);
  const Vec3d center = center_of(page.scene());
  const ViewerMessage frame = page.frame();
  expect_rows(frame, "proximity_pairs", expected.proximity_pairs, center);
  expect_rows(frame, "penetrations", expected.penetrations, center);
  expect_rows(frame, "curves", expected.curves, center);
  expect_rows(frame, "manifolds", expected.manifolds, center);
  EXPECT_GT(expected.proximity_pairs.size(), 0u);
  EXPECT_GT(expected.penetrations.size(), 0u);
  EXPECT_GT(expected.curves.size(), 0u);
  EXPECT_FALSE(expected.enclosed_vertices.empty());
  EXPECT_EQ(column_of<std::uint32_t>(frame, "enclosed_vertices", "vertex"),
            std::vector(expected.enclosed_vertices.begin(), expected.enclosed_vertices.end()));
  TestPage plain(touching_balls());
  plain.scene();
  const ViewerMessage other = plain.frame();
  EXPECT_GT(count_of(other, "contacts"), 0u);
  for (const char* list : {"proximity_pairs", "penetrations", "curves", "enclosed_vertices"})
    EXPECT_EQ(count_of(other, list), 0u) << list;
}

/// The events of volumes and of the narrow phase are those of a scene with colliding vertices.
TEST(ViewerFrames, EventsOfVolumesAndOfTheNarrowPhase) {
  SceneView show = touching_balls(), giving = show;
  giving.simulation.scene.comparison.colliding_vertices = true;
  Simulation simulation = simulation_of(giving);
  TestPage page(show);
  page.scene();
  EXPECT_FALSE(page.frame().has(46)) << "only with the layer";
  page.ask({{"do", "layers"}, {"colliding_vertices", true}});
  std::size_t volumes = 0, leaves = 0;
  for (int step = 0; step < 80; ++step) {
    const ViewerMessage frame = step == 0 ? page.frame() : page.frame_after_steps(1);
    if (step > 0) simulation.step();
    const DetectResult& result = simulation.scene().result();
    const auto expect = [&](std::uint32_t tag, std::span<const ObjectPair> pairs) {
      std::vector<StepPair> expected;
      for (const ObjectPair& pair : pairs)
        expected.push_back({static_cast<std::uint32_t>(step), pair.a.index, pair.b.index});
      EXPECT_EQ(frame.values<StepPair>(tag), expected) << tag << " in step " << step;
      return expected.size();
    };
    if (step > 0) {  // the frame before the layer had the volumes already
      volumes += expect(48, result.volume_events.begin);
      expect(49, result.volume_events.end);
    }
    leaves += expect(46, result.narrow_phase_events.begin);
    expect(47, result.narrow_phase_events.end);
  }
  EXPECT_GT(volumes, 0u);
  EXPECT_GT(leaves, 1u);
}

/// A frame brings the events of every step since the last frame, as the library has them.
TEST(ViewerFrames, EventsOfEveryStepArrive) {
  const SceneView show = touching_balls();
  Simulation simulation = simulation_of(show);
  TestPage page(show);
  page.scene();
  std::vector<StepPair> begin, end, expected_begin, expected_end;
  const auto take = [](const ViewerMessage& frame, std::uint32_t tag, std::vector<StepPair>& events) {
    const std::vector<StepPair> sent = frame.values<StepPair>(tag);
    events.insert(events.end(), sent.begin(), sent.end());
  };
  const auto expect = [&](std::span<const ObjectPair> pairs, std::vector<StepPair>& events) {
    for (const ObjectPair& pair : pairs)
      events.push_back({static_cast<std::uint32_t>(simulation.step_count()), pair.a.index, pair.b.index});
  };
  const auto take_both = [&](const ViewerMessage& frame) {
    take(frame, 44, begin);
    take(frame, 45, end);
  };
  take_both(page.frame());
  expect(simulation.scene().result().contact_events.begin, expected_begin);
  // Ball 2 drifts through balls 1 and 0; most of these steps have no frame.
  for (const int count : {1, 100, 3, 400, 500}) {
    take_both(page.frame_after_steps(count));
    for (int i = 0; i < count; ++i) {
      const PairEvents& events = simulation.step().contact_events;
      expect(events.begin, expected_begin);
      expect(events.end, expected_end);
    }
  }
  EXPECT_EQ(begin, expected_begin);
  EXPECT_EQ(end, expected_end);
  EXPECT_GT(begin.size(), 2u);
  EXPECT_GT(end.size(), 1u);
  page.session.greet();
  page.scene();
  const ViewerMessage again = page.frame();
  EXPECT_EQ(again.values<StepPair>(44), expected_begin) << "a page that comes again gets all events";
  page.ask({{"do", "reset"}});
  page.drain();
  EXPECT_EQ(page.frame_after_steps(1).values<StepPair>(44), (std::vector<StepPair>{{0, 0, 1}}))
      << "a new run has events of its own";
}

/// A frame brings the statistics of every step since the last frame, also of steps without a frame.
TEST(ViewerFrames, StatisticsOfEveryStepArrive) {
  const SceneView show = touching_balls();
  Simulation simulation = simulation_of(show);
  TestPage page(show);
  const Json names = page.scene().json["statistics"];
  const std::size_t columns = names.size();
  const auto contacts =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), "contacts") - names.begin());
  std::vector<double> expected{static_cast<double>(simulation.scene().result().contacts.size())}, sent;
  const auto take = [&](const ViewerMessage& frame) {
    const std::vector<double> values = frame.values<double>(43);
    for (std::size_t row = 0; row < values.size() / columns; ++row)
      sent.push_back(values[row * columns + contacts]);
  };
  take(page.frame());
  for (const int count : {1, 7, 2, 60}) {
    take(page.frame_after_steps(count));
    for (int i = 0; i < count; ++i)
      expected.push_back(static_cast<double>(simulation.step().contacts.size()));
  }
  EXPECT_EQ(sent, expected);
  page.session.greet();
  page.scene();
  sent.clear();
  take(page.frame());
  EXPECT_EQ(sent, expected) << "a page that comes again gets all steps again";
  page.say({{"do", "reset"}});
  page.scene();
  EXPECT_EQ(page.frame().section(43).count, columns);
}

TEST(ViewerFrames, StatisticsOfTheLastStepsAreKeptForAPageThatTakesNoFrames) {
  TestPage page(touching_balls());
  const std::size_t columns = page.scene().json["statistics"].size();
  page.frame();
  page.ask({{"do", "step"}, {"count", 5000}});
  for (int i = 0; i < 5000; ++i) page.session.advance(0);
  const std::size_t rows = page.frame().section(43).count / columns;
  EXPECT_GE(rows, 3000u);
  EXPECT_LE(rows, 4000u);
}

TEST(ViewerFrames, ContinuousContactsAreThoseOfTheLibrary) {
  SceneView show = touching_balls();
  show.simulation.scene.contacts = ContactKinds::continuous;
  Simulation simulation = simulation_of(show);
  TestPage page(show);
  const Vec3d center = center_of(page.scene());
  std::size_t most = 0;
  for (int step = 1; step <= 60; ++step) {
    const auto expected = simulation.step().continuous_contacts;
    const ViewerMessage frame = page.frame_after_steps(1);
    expect_rows(frame, "continuous_contacts", expected, center);
    most = std::max(most, expected.size());
    EXPECT_EQ(count_of(frame, "contacts"), 0u);
  }
  EXPECT_GT(most, 0u);
}

TEST(ViewerFrames, WhatIsNoNumberIsNaN) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinity = std::numeric_limits<double>::infinity();
  SceneView show;
  show.objects = {test_ball("whole", {}), test_ball("broken", {1.5, 0, 0})};
  show.objects[1].mesh.positions[4] = {1, nan, -infinity};
  show.objects[1].mesh.positions[7] = {1e300, 0, 0};
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  const auto sent = page.frame().values<Vec3f>(32, 1);
  EXPECT_TRUE(std::isnan(sent[4].y) && std::isnan(sent[4].z));
  // The centre of the bounds is at 5e299. Relative to it no x coordinate fits in a float, so NaN is sent.
  EXPECT_EQ(scene.json["center"][0], 5e299);
  EXPECT_TRUE(std::isnan(sent[7].x) && std::isnan(sent[0].x));
  EXPECT_EQ(page.ask({{"do", "read"}, {"object", 1}, {"vertex", 4}})["position"],
            (Json{1.0, nullptr, nullptr}));
  EXPECT_FALSE(page.failure(R"({"do": "grab", "object": 1, "vertex": 4})").empty());
}

TEST(ViewerFrames, FarAwayFloatsStayPrecise) {
  const Vec3d far{1e7, -2e7, 3e7};
  SceneView show = touching_balls();
  for (ViewedObject& object : show.objects)
    for (Vec3d& p : object.mesh.positions) p = p + far;
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  const Vec3d center = center_of(scene);
  const auto sent = page.frame().values<Vec3f>(32, 1);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const Vec3d p = show.objects[1].mesh.positions[i];
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(center[axis] + sent[i][axis], p[axis], 1e-7);
  }
  for (const auto& corner : scene.json["bounds"])
    for (const double x : corner) EXPECT_LT(std::fabs(x), 4);
}

TEST(ViewerFrames, BorderIsSentWithoutTheCentre) {
  SceneView show = touching_balls();
  TestPage open(show);
  EXPECT_EQ(open.scene().json["border"], nullptr);
  show.simulation.border = Border{Vec3d{-4, 0, 0}, Vec3d{12, 2, 2}};
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  const Vec3d center = center_of(scene);
  EXPECT_EQ(scene.json["border"],
            (Json{{-4 - center.x, -center.y, -center.z}, {12 - center.x, 2 - center.y, 2 - center.z}}));
}

TEST(ViewerFrames, SayWhatWasNotTested) {
  SceneView show = touching_balls();
  TestPage tested(show);
  tested.scene();
  EXPECT_EQ(tested.frame().json["untested"], Json::array());
  show.objects.resize(1);
  TestPage page(show);
  page.scene();
  EXPECT_EQ(page.frame().json["untested"], (Json{{{"kind", "intersection"}, {"reason", "one_object"}}}));
}

}  // namespace supple::viewer::session_frames_test
