// The past of a simulation: the steps that a session keeps.

#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "../../support/viewer_page.hpp"

namespace supple::viewer::session_history_test {

constexpr double bytes_of_ball = 92 * sizeof(Vec3d);

SceneView flight(ContactKinds contacts = ContactKinds::intersection) {
  SceneView show = touching_balls();
  show.simulation.scene.contacts = contacts;
  return show;
}

ViewerMessage frame_at(TestPage& page, std::uint64_t step) {
  page.ask({{"do", "seek"}, {"frame", step}});
  page.session.advance(0);
  return page.frame();
}

TEST(ViewerHistory, EachKeptStepIsDetectedAsItWas) {
  for (const ContactKinds contacts :
       {ContactKinds::intersection, ContactKinds::intersection | ContactKinds::continuous}) {
    TestPage page(flight(contacts));
    page.scene();
    std::vector<ViewerMessage> live{page.frame()};
    for (int step = 1; step <= 120; ++step) live.push_back(page.frame_after_steps(1));
    EXPECT_EQ(live.back().json["range"], (Json{0, 120}));
    EXPECT_EQ(live.back().json["past"], false);
    for (const std::uint64_t step : {119u, 60u, 61u, 0u, 1u, 118u}) {
      const ViewerMessage past = frame_at(page, step);
      EXPECT_EQ(past.json["step"], step);
      EXPECT_EQ(past.json["time"], live[step].json["time"]);
      EXPECT_EQ(past.json["past"], true);
      EXPECT_EQ(past.json["range"], (Json{0, 120}));
      EXPECT_EQ(columns_of(past), columns_of(live[step])) << "in step " << step;
      EXPECT_FALSE(past.has(44)) << "the page has the events";
    }
    const ViewerMessage present = frame_at(page, 120);
    EXPECT_EQ(present.json["past"], false);
    EXPECT_EQ(columns_of(present), columns_of(live[120]));
    EXPECT_EQ(page.frame_after_steps(1).json["step"], 121) << "the simulation goes on from its last step";
  }
}

TEST(ViewerHistory, TheSimulationGoesOnAsIfNobodyHadLookedBack) {
  SceneView show = three_balls();
  TestPage page(show), undisturbed(show);
  for (TestPage* const each : {&page, &undisturbed}) {
    each->scene();
    each->frame();
    each->frame_after_steps(40);
  }
  frame_at(page, 3);
  frame_at(page, 40);
  const ViewerMessage one = page.frame_after_steps(100), other = undisturbed.frame_after_steps(100);
  for (std::uint32_t object = 0; object < 2; ++object)
    EXPECT_EQ(one.section(32, object).data, other.section(32, object).data);
  EXPECT_EQ(columns_of(one), columns_of(other));
}

TEST(ViewerHistory, StepsBackAndPlaysForwardToThePresent) {
  TestPage page(flight());
  page.scene();
  page.frame();
  page.frame_after_steps(10);
  const auto step = [&](int count) {
    page.ask({{"do", "step"}, {"count", count}});
    page.session.advance(0);
    return page.frame();
  };
  EXPECT_EQ(step(-1).json["step"], 9);
  EXPECT_EQ(step(-3).json["step"], 6);
  EXPECT_EQ(step(1).json["step"], 7);
  EXPECT_EQ(step(-100).json["step"], 0);
  EXPECT_EQ(step(4).json["past"], true);
  page.ask({{"do", "play"}});
  for (int i = 0; i < 40; ++i) page.session.advance(0.01);
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.json["past"], false);
  EXPECT_EQ(frame.json["playing"], true);
  EXPECT_GT(frame.json["step"], 10);
  EXPECT_LE(frame.json["step"], 44);
}

TEST(ViewerHistory, ASectionLoops) {
  TestPage page(flight());
  page.scene();
  page.frame();
  page.frame_after_steps(30);
  frame_at(page, 10);
  page.ask({{"do", "loop"}, {"on", true}, {"from", 10}, {"to", 14}});
  page.ask({{"do", "play"}});
  std::vector<int> seen;
  for (int i = 0; i < 12; ++i) {
    page.session.advance(0.01);
    const ViewerMessage frame = page.frame();
    EXPECT_EQ(frame.json["section"], (Json{10, 14}));
    seen.push_back(frame.json["step"].get<int>());
  }
  EXPECT_EQ(seen, (std::vector{11, 12, 13, 14, 10, 11, 12, 13, 14, 10, 11, 12}));
  page.ask({{"do", "loop"}, {"on", false}});
  for (int i = 0; i < 60; ++i) page.session.advance(0.01);
  EXPECT_EQ(page.frame().json["past"], false);
  EXPECT_NE(page.failure(R"({"do": "loop", "on": true, "from": 3})").find("need each other"),
            std::string::npos);
  EXPECT_NE(page.failure(R"({"do": "loop", "on": true, "from": 3, "to": 2})").find("to"), std::string::npos);
}

TEST(ViewerHistory, KeepsTheLastStepsWithinItsMemory) {
  // In each step only one ball moves. The first kept step is only the begin of the motion of the next one.
  constexpr double room = 5 * bytes_of_ball + 2 * bytes_of_ball;
  TestPage page(flight(), {.history_bytes = room});
  page.scene();
  page.frame();
  EXPECT_EQ(page.frame_after_steps(30).json["range"], (Json{27, 30}));
  EXPECT_NE(page.failure(R"({"do": "seek", "frame": 26})").find("27 to 30"), std::string::npos);
  EXPECT_EQ(frame_at(page, 27).json["step"], 27);
  TestPage forgetful(flight(), {.history_bytes = 0});
  forgetful.scene();
  forgetful.frame();
  EXPECT_EQ(forgetful.frame_after_steps(5).json["range"], (Json{5, 5}));
  EXPECT_NE(forgetful.failure(R"({"do": "seek", "frame": 5})").find("no steps are kept"), std::string::npos);
  TestPage tiny(flight(), {.history_bytes = 1});
  tiny.scene();
  tiny.frame();
  EXPECT_EQ(tiny.frame_after_steps(5).json["range"], (Json{5, 5}));
}

TEST(ViewerHistory, OtherOptionsDetectAPastStepAgain) {
  TestPage page(flight());
  page.scene();
  page.frame();
  page.frame_after_steps(20);
  const ViewerMessage past = frame_at(page, 7);
  EXPECT_EQ(count_of(past, "proximity_pairs"), 0u);
  page.say({{"do", "set"}, {"contacts", "intersection,proximity"}, {"bounding_volume", "sphere"}});
  const ViewerMessage scene = page.only(ViewerMessage::scene);
  EXPECT_EQ(scene.json["bounding_volume"], "sphere");
  EXPECT_EQ(scene.json["source"], "simulation");
  const ViewerMessage again = page.frame();
  EXPECT_EQ(again.json["step"], 7);
  EXPECT_EQ(again.json["past"], true);
  EXPECT_GT(count_of(again, "proximity_pairs"), 0u);
  EXPECT_EQ(contacts_in(again), contacts_in(past));
  const ViewerMessage present = frame_at(page, 20);
  EXPECT_EQ(present.json["past"], false);
  EXPECT_GT(count_of(present, "proximity_pairs"), 0u);
}

TEST(ViewerHistory, ThePastCannotBePulled) {
  TestPage page(three_balls());
  page.scene();
  page.frame();
  page.frame_after_steps(5);
  frame_at(page, 2);
  EXPECT_NE(page.failure(R"({"do": "grab", "object": 0, "vertex": 0})").find("newest step"),
            std::string::npos);
  frame_at(page, 5);
  page.ask({{"do", "grab"}, {"object", 2}, {"vertex", 0}});
  page.ask({{"do", "drag"}, {"to", {0, 0, 1}}});
  const ViewerMessage past = frame_at(page, 4);  // lets go
  EXPECT_EQ(past.json["past"], true);
  EXPECT_EQ(frame_at(page, 5).json["past"], false);
  EXPECT_NE(page.failure(R"({"do": "drag", "to": [0, 0, 2]})").find("nothing is held"), std::string::npos);
}

TEST(ViewerHistory, AnswersAreAboutTheStepThatIsShown) {
  TestPage page(flight());
  page.scene();
  page.frame();
  page.frame_after_steps(100);
  page.ask({{"do", "seek"}, {"frame", 0}});
  Scene expected;
  for (const ViewedObject& object : flight().objects) {
    TriangleMesh mesh = object.mesh;
    if (const auto* const waves = std::get_if<WaveMotion>(&object.motion))
      apply_wave_motion(*waves, {}, object.mesh.positions, 0, mesh.positions);
    expected.add(mesh, {.name = object.options.name});
  }
  expected.detect();
  const Json answer = page.ask({{"do", "read"}, {"object", 2}, {"vertex", 5}});
  const Vec3d position = expected.position(expected.objects()[2], 5);
  EXPECT_EQ(answer["position"], (Json{position.x, position.y, position.z}));
}

TEST(ViewerHistory, AResetForgetsThePast) {
  TestPage page(flight());
  page.scene();
  page.frame();
  page.frame_after_steps(10);
  frame_at(page, 4);
  page.ask({{"do", "reset"}});
  page.drain();
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.json["step"], 0);
  EXPECT_EQ(frame.json["past"], false);
  EXPECT_EQ(frame.json["range"], (Json{0, 0}));
}

TEST(ViewerHistory, APageThatComesAgainFindsThePastItLookedAt) {
  TestPage page(flight());
  page.scene();
  page.frame();
  page.frame_after_steps(10);
  frame_at(page, 4);
  page.session.greet();
  page.scene();
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.json["step"], 4);
  EXPECT_EQ(frame.json["past"], true);
  for (std::uint32_t object = 0; object < 3; ++object) EXPECT_TRUE(frame.has(32, object));
}

}  // namespace supple::viewer::session_history_test
