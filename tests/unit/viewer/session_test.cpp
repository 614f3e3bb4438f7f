#include "session/session.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "../../support/viewer_page.hpp"
#include "session/messages/long_steps.hpp"

namespace supple::viewer::session_test {

TEST(ViewerSession, TellsTheSceneAndThenFramesAgainstCredit) {
  Session unseen(three_balls());
  MessageWriter message;
  EXPECT_TRUE(unseen.next_message(message).empty());  // no page was greeted
  unseen.advance(1);
  EXPECT_TRUE(unseen.next_message(message).empty());

  TestPage page(three_balls());
  const ViewerMessage scene = page.scene();
  EXPECT_EQ(scene.json["title"], "balls");
  EXPECT_EQ(scene.json["source"], "simulation");
  EXPECT_EQ(scene.json["generation"], 1);
  EXPECT_EQ(scene.json["frames"], nullptr);
  EXPECT_EQ(scene.json["integrator"], "verlet");
  EXPECT_EQ(scene.json["can"], (Json{"play", "reset", "grab", "set"}));
  ASSERT_EQ(scene.json["objects"].size(), 3u);
  EXPECT_EQ(scene.json["objects"][1], (Json{{"name", "soft"},
                                            {"vertices", 92},
                                            {"triangles", 180},
                                            {"static", false},
                                            {"body", true},
                                            {"rigid", false},
                                            {"waves", false},
                                            {"self_collision", false},
                                            {"margin", 0.0}}));
  EXPECT_EQ(scene.values<Triangle>(16, 2), make_icosphere(3).triangles);
  EXPECT_EQ(scene.section(16, 2).count, 180u);
  EXPECT_TRUE(page.drain().empty());  // the page has given no credit

  page.say({{"do", "credit"}, {"frames", 2}});
  const ViewerMessage first = page.only(ViewerMessage::frame);  // no other message follows
  EXPECT_EQ(first.json["step"], 0);
  EXPECT_EQ(first.json["playing"], true);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(first.section(32, i).count, 92u);
  page.session.advance(0.01);
  EXPECT_TRUE(page.drain().empty());  // the page has not drawn the first frame
  page.say({{"do", "credit"}, {"frames", 0}});
  page.session.advance(0.01);
  const ViewerMessage second = page.only(ViewerMessage::frame);
  EXPECT_EQ(second.json["step"], 1);
  EXPECT_EQ(second.json["time"], 0.01);
  EXPECT_TRUE(second.has(32, 0) && second.has(32, 1));
  EXPECT_FALSE(second.has(32, 2)) << "objects at rest are not sent again";
  page.session.advance(0.01);
  EXPECT_TRUE(page.drain().empty());
}

TEST(ViewerSession, SendsTheNewestStateOnlyAndKeepsLittleCredit) {
  TestPage page(three_balls());
  page.scene();
  page.frame();
  for (int i = 0; i < 20; ++i) page.session.advance(0.01);
  EXPECT_EQ(page.frame().json["step"], 20);
  page.say({{"do", "credit"}, {"frames", 1000}});
  page.say({{"do", "credit"}, {"frames", 1000}});
  int frames = 0;
  for (int i = 0; i < 30; ++i) {
    page.session.advance(0.01);
    frames += static_cast<int>(page.drain().size());
  }
  EXPECT_EQ(frames, 8);
}

TEST(ViewerSession, APageThatComesAgainGetsAllAfresh) {
  TestPage page(three_balls());
  page.scene();
  page.ask({{"do", "pause"}});
  page.say({{"do", "credit"}, {"frames", 5}});
  page.drain();
  page.session.command("?");
  page.session.greet();
  const ViewerMessage scene = page.scene();  // the failure and the credit belonged to the previous page
  EXPECT_EQ(scene.json["generation"], 2);
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.json["generation"], 2);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(frame.has(32, i));
}

TEST(ViewerSession, ABodyThatBlowsUpPausesTheSession) {
  SceneView show = three_balls();
  show.objects[1].motion =
      MassSpringMotion{.springs = {.vertex_mass = 1e-6, .stiffness = 1e4}, .velocity = {-1, 0, 0}};
  // The body is out of balance from the start.
  show.objects[1].motion = MassSpringMotion{
      .springs = {.vertex_mass = 1e-6, .stiffness = 1e4}, .random_force = 1, .deform_seconds = 1};
  TestPage page(show);
  page.scene();
  page.frame();
  std::optional<ViewerMessage> failure;
  for (int i = 0; i < 200 && !failure; ++i) {
    page.session.advance(0.01);
    const std::vector<ViewerMessage> messages = page.drain();
    if (!messages.empty()) failure = messages.front();
  }
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, ViewerMessage::failure);
  EXPECT_EQ(failure->json["fatal"], false);
  EXPECT_FALSE(failure->json.contains("id"));
  EXPECT_NE(failure->json["message"].get<std::string>().find("soft"), std::string::npos);
  EXPECT_EQ(page.frame().json["playing"], false);
  EXPECT_FALSE(page.session.ended());
  EXPECT_NO_THROW(page.ask({{"do", "set"}, {"integrator", "backward_euler"}}));
  page.frame_after_steps(20);
}

TEST(ViewerSession, WarnsOfStepsThatAreTooLongForAsLongAsTheyAre) {
  SceneView show = three_balls();
  EXPECT_EQ(TestPage(show).scene().json["warnings"], Json::array());
  show.objects[1].motion = MassSpringMotion{.springs = {.vertex_mass = 1e-3, .stiffness = 1e4}};
  TestPage page(show);
  const Json warnings = page.scene().json["warnings"];
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], warning_of_long_steps(simulation_of(show)));
  EXPECT_TRUE(warnings[0].get<std::string>().starts_with("time_step 0.01 is too long for soft: "))
      << warnings;

  const auto warnings_after = [&](const Json& command) {
    page.say(command);
    return page.drain().at(0).json["warnings"];
  };
  EXPECT_EQ(warnings_after({{"do", "reset"}}), warnings);
  const Json both = warnings_after({{"do", "set"}, {"objects", 6}});
  EXPECT_NE(both.at(0).get<std::string>().find("soft and 1 other object: "), std::string::npos) << both;
  EXPECT_EQ(warnings_after({{"do", "set"}, {"integrator", "backward_euler"}}), Json::array());
  EXPECT_EQ(warnings_after({{"do", "set"}, {"integrator", "verlet"}, {"time_step", 1e-6}}), Json::array());
}

TEST(ViewerSession, EmptyShowsObjectsAndMeshesAreFine) {
  TestPage nothing(SceneView{});
  EXPECT_EQ(nothing.scene().json["objects"].size(), 0u);
  EXPECT_EQ(nothing.frame().json["step"], 0);
  EXPECT_EQ(nothing.frame_after_steps(2).json["step"], 2);
  nothing.say({{"do", "set"}, {"objects", 5}});
  EXPECT_EQ(nothing.scene().json["objects"].size(), 0u);

  SceneView show;
  show.objects.emplace_back().mesh.name = "no vertices";
  show.objects.push_back({TriangleMesh{"points", {{0, 0, 0}, {1, 1, 1}}, {}}});
  show.objects.push_back(test_ball("ball", {}));
  show.objects[0].motion = WaveMotion{.amplitude = 1};
  show.objects[1].motion = WaveMotion{.amplitude = 1};
  TestPage page(show);
  page.scene();
  page.ask({{"do", "layers"},
            {"candidates", true},
            {"scene_regions", true},
            {"colliding_vertices", true},
            {"octree", {{"objects", {0, 1, 2}}, {"level", -1}}}});
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.section(32, 0).count, 0u);
  EXPECT_EQ(frame.section(32, 1).count, 2u);
  EXPECT_EQ(frame.json["octree_levels"].size(), 3u);
  page.frame_after_steps(3);
  EXPECT_EQ(page.ask({{"do", "read"}, {"object", 0}})["bounds"], nullptr);
}

TEST(ViewerSession, NamesThatAreNoUtf8AreMended) {
  SceneView show;
  show.title = "caf\xc3\xa9 \xff";
  show.objects = {test_ball("\xc3(\x80", {})};
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  EXPECT_EQ(scene.json["title"], "caf\xc3\xa9 \xef\xbf\xbd");
  EXPECT_EQ(scene.json["objects"][0]["name"], "\xef\xbf\xbd(\xef\xbf\xbd");
}

TEST(ViewerSession, RefusesWhatAnObjectMustNotBe) {
  SceneView show = three_balls();
  show.objects[0].motion = WaveMotion{.wavelength = 0};
  EXPECT_THROW(TestPage{show}, Error);
  show = three_balls();
  show.objects[0].mesh.triangles[5][1] = 92;
  EXPECT_THROW(TestPage{show}, Error);
  show = three_balls();
  show.simulation.time_step = 0;
  EXPECT_THROW(TestPage{show}, Error);
}

}  // namespace supple::viewer::session_test
