#include "session/session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../../support/viewer_page.hpp"

namespace supple::viewer {
namespace {

using Json = nlohmann::json;
using Message = ViewerMessage;
using Pair = std::array<std::uint32_t, 2>;
using Row = std::array<float, 8>;

/// A number of the frame's statistics by its name.
double statistic(const Message& scene, const Message& frame, const std::string& name) {
  const auto names = scene.json["statistics"].get<std::vector<std::string>>();
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  const std::vector<double> values = frame.values<double>(43);
  EXPECT_EQ(values.size(), names.size());
  return values[static_cast<std::size_t>(found - names.begin())];
}

/// Two balls that cut through each other, and one in waves a little further on.
Show touching_balls() {
  Show show;
  show.objects = {test_ball("left", {}), test_ball("right", {1.5, 0, 0}), test_ball("waves", {4, 0, 0})};
  show.objects[2].motion = Sway{.velocity = {-1, 0.1, 0}, .amplitude = 0.05};
  return show;
}

TEST(ViewerSession, TellsTheSceneAndThenFramesAgainstCredit) {
  Session unseen(three_balls());
  MessageWriter message;
  EXPECT_TRUE(unseen.next_message(message).empty());  // nobody was greeted
  unseen.advance(1);
  EXPECT_TRUE(unseen.next_message(message).empty());

  TestPage page(three_balls());
  const Message scene = page.scene();
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
                                            {"waves", false},
                                            {"self_collision", false}}));
  EXPECT_EQ(scene.values<Triangle>(16, 2), make_icosphere(3).triangles);
  EXPECT_EQ(scene.section(16, 2).count, 180u);
  EXPECT_TRUE(page.drain().empty());  // no credit

  page.say({{"do", "credit"}, {"frames", 2}});
  const Message first = page.only(Message::frame);  // and nothing new after it
  EXPECT_EQ(first.json["step"], 0);
  EXPECT_EQ(first.json["playing"], true);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(first.section(32, i).count, 92u);
  page.session.advance(0.01);
  const Message second = page.only(Message::frame);
  EXPECT_EQ(second.json["step"], 1);
  EXPECT_EQ(second.json["time"], 0.01);
  EXPECT_TRUE(second.has(32, 0) && second.has(32, 1));
  EXPECT_FALSE(second.has(32, 2)) << "what rests is not sent again";
  page.session.advance(0.01);
  EXPECT_TRUE(page.drain().empty());
}

TEST(ViewerSession, SendsTheNewestStateOnlyAndKeepsLittleCredit) {
  TestPage page(three_balls());
  page.scene();
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

TEST(ViewerSession, ShowsWhatTheLibraryFinds) {
  Show show = touching_balls();
  Simulation simulation = simulation_of(show);
  TestPage page(show);
  const Message scene = page.scene();
  const Vec3d center = center_of(scene);
  std::size_t contacts = 0, last = 0;
  for (std::uint32_t step = 0; step < 80; ++step) {
    if (step > 0) simulation.step();
    const Message frame = step == 0 ? page.frame() : page.frame_after_steps(1);
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

TEST(ViewerSession, NormalsAreThoseOfTriangleBOrOfAWhereBHasNone) {
  TestPage page(touching_balls());
  page.scene();
  const Message frame = page.frame();
  const TriangleMesh ball = test_ball("", {1.5, 0, 0}).mesh;
  for (const auto& contact : frame.values<std::array<std::uint32_t, 8>>(34)) {
    ASSERT_EQ(contact[2], 1u);
    const Triangle& t = ball.triangles[contact[3]];
    const Vec3d ab = ball.positions[t[1]] - ball.positions[t[0]],
                ac = ball.positions[t[2]] - ball.positions[t[0]];
    const Row point = frame.values<Row>(35)[contact[6]];
    const Vec3d n{point[4], point[5], point[6]};
    EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1, 1e-6);
    EXPECT_NEAR(n.x * ab.x + n.y * ab.y + n.z * ab.z, 0, 1e-6);
    EXPECT_NEAR(n.x * ac.x + n.y * ac.y + n.z * ac.z, 0, 1e-6);
  }

  // A needle without area through a face: the face's normal, whichever comes first.
  Show needle;
  needle.objects.push_back({TriangleMesh{"face", {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}}});
  needle.objects.push_back({TriangleMesh{"needle", {{0, 0, -1}, {0, 0, 1}, {0, 0, 1}}, {{0, 1, 2}}}});
  TestPage second(needle);
  second.scene();
  const Row point = second.frame().values<Row>(35).at(0);
  EXPECT_EQ((Vec3f{point[4], point[5], point[6]}), (Vec3f{0, 0, 1}));
}

TEST(ViewerSession, EventsAreThoseSinceTheLastFrame) {
  TestPage page(touching_balls());
  page.scene();
  const Message first = page.frame();
  EXPECT_EQ(first.values<Pair>(44), (std::vector<Pair>{{0, 1}}));
  EXPECT_TRUE(first.values<Pair>(45).empty());
  // Ball 2 drifts into 1 within many steps, of which none is sent.
  for (int i = 0; i < 100; ++i) page.session.advance(0.01);
  const Message later = page.frame();
  EXPECT_EQ(later.values<Pair>(44), (std::vector<Pair>{{1, 2}}));
  EXPECT_TRUE(page.frame_after_steps(1).values<Pair>(44).empty());
  page.ask({{"do", "reset"}});
  page.drain();
  EXPECT_EQ(page.frame_after_steps(1).values<Pair>(44), (std::vector<Pair>{{0, 1}}))
      << "the page knows of none";
}

TEST(ViewerSession, ContinuousContactsAreThoseOfTheLibrary) {
  Show show = touching_balls();
  show.simulation.scene.contacts = ContactMode::continuous;
  Simulation simulation = simulation_of(show);
  TestPage page(show);
  const Vec3d center = center_of(page.scene());
  std::size_t most = 0;
  for (int step = 1; step <= 60; ++step) {
    const auto expected = simulation.step().continuous_contacts;
    const Message frame = page.frame_after_steps(1);
    const auto ids = frame.values<std::array<std::uint32_t, 8>>(36);
    const auto points = frame.values<Row>(37);
    ASSERT_EQ(ids.size(), expected.size());
    ASSERT_EQ(points.size(), expected.size());
    most = std::max(most, ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const ContinuousContact& c = expected[i];
      const std::array<std::uint32_t, 8> row{c.object_a.index,
                                             c.element_a[0],
                                             c.element_a[1],
                                             c.object_b.index,
                                             c.element_b[0],
                                             c.element_b[1],
                                             static_cast<std::uint32_t>(c.kind),
                                             static_cast<std::uint32_t>(c.certainty)};
      ASSERT_EQ(ids[i], row);
      EXPECT_EQ((Vec3f{points[i][0], points[i][1], points[i][2]}), as_floats(std::array{c.point}, center)[0]);
      EXPECT_EQ(points[i][3], static_cast<float>(c.time));
      EXPECT_EQ((Vec3f{points[i][4], points[i][5], points[i][6]}), as_floats(std::array{c.normal}, {})[0]);
    }
    EXPECT_TRUE(frame.values<std::byte>(34).empty());
  }
  EXPECT_GT(most, 0u);
}

TEST(ViewerSession, WhatIsNotUnderstoodIsAFailureAndDoesNothing) {
  TestPage page(three_balls());
  page.scene();
  page.ask({{"do", "pause"}});
  const Message before = page.frame();
  const std::vector<std::string> wrong{
      "",
      " ",
      "{",
      "}",
      "nothing",
      "[]",
      "17",
      "null",
      "\"play\"",
      "{}",
      "{\"do\"}",
      "{\"do\": 1}",
      "{\"do\": \"play\"} x",
      "{\"do\": \"fly\"}",
      "{\"do\": \"play\", \"id\": \"x\"}",
      "{\"do\": \"play\", \"speed\": 1}",
      "{\"do\": \"\xff\xfe\"}",
      std::string("{\"do\": \"pl\0ay\"}", 16),
      std::string(1'000'000, '['),
      "{\"do\": " + std::string(100'000, '{'),
      R"({"do": "credit"})",
      R"({"do": "credit", "frames": -1})",
      R"({"do": "credit", "frames": 1.5})",
      R"({"do": "credit", "frames": 1e300})",
      R"({"do": "step", "count": 0})",
      R"({"do": "step", "count": -1})",
      R"({"do": "step", "count": "1"})",
      R"({"do": "speed"})",
      R"({"do": "speed", "factor": 11})",
      R"({"do": "speed", "factor": 0.05})",
      R"({"do": "speed", "factor": -1})",
      R"({"do": "speed", "factor": null})",
      R"({"do": "loop", "on": true})",
      R"({"do": "seek", "frame": 0})",
      R"({"do": "layers", "candidates": 1})",
      R"({"do": "layers", "octree": 3})",
      R"({"do": "layers", "octree": {"objects": [3], "level": 1}})",
      R"({"do": "layers", "octree": {"objects": [0]}})",
      R"({"do": "layers", "octree": {"objects": [0.5], "level": 1}})",
      R"({"do": "layers", "octree": {"objects": [0], "level": -2}})",
      R"({"do": "layers", "octree": {"objects": [0], "level": 1, "colour": 2}})",
      R"({"do": "reset", "seed": -1})",
      R"({"do": "reset", "seed": 0.5})",
      R"({"do": "set", "bounding_volume": "cube"})",
      R"({"do": "set", "bounding_volume": 1})",
      R"({"do": "set", "max_level": 33})",
      R"({"do": "set", "leaf_size": 0})",
      R"({"do": "set", "objects": 0})",
      R"({"do": "set", "objects": 10000000})",
      R"({"do": "set", "integrator": "rk4"})",
      R"({"do": "set", "time_step": 0})",
      R"({"do": "set", "time_step": "x"})",
      R"({"do": "set", "colour": "red"})",
      R"({"do": "grab"})",
      R"({"do": "grab", "object": 3, "vertex": 0})",
      R"({"do": "grab", "object": 0, "vertex": 92})",
      R"({"do": "grab", "object": 0, "vertex": -1})",
      R"({"do": "grab", "object": 0, "vertex": 0, "radius": 0})",
      R"({"do": "grab", "object": 4294967296, "vertex": 0})",
      R"({"do": "drag", "to": [0, 0, 0]})",
      R"({"do": "drag", "to": [0, 0]})",
      R"({"do": "drag", "to": [0, 0, "x"]})",
      R"({"do": "explain", "a": [0, 0], "b": [1, 0]})",
      R"({"do": "explain", "a": [0, 0], "id": 1})",
      R"({"do": "explain", "a": [0, 180], "b": [1, 0], "id": 1})",
      R"({"do": "explain", "a": [9, 0], "b": [1, 0], "id": 1})",
      R"({"do": "explain", "a": [0], "b": [1, 0], "id": 1})",
      R"({"do": "read", "object": 0})",
      R"({"do": "read", "object": 3, "id": 1})",
      R"({"do": "read", "id": 1})",
      R"({"do": "read", "object": 0, "vertex": 92, "id": 1})",
      R"({"do": "read", "object": 0, "triangle": 180, "id": 1})",
      R"({"do": "read", "object": 0, "triangle": 1, "vertex": 1, "id": 1})"};
  for (const std::string& command : wrong) {
    const std::string shown = command.substr(0, 80);
    std::string failure;
    ASSERT_NO_THROW(failure = page.failure(command)) << shown;
    EXPECT_GT(failure.size(), 10u) << shown;
    EXPECT_LT(failure.size(), 400u) << shown;
    EXPECT_EQ(failure.find('\n'), std::string::npos) << shown;
  }
  page.say({{"do", "credit"}, {"frames", 1}});
  EXPECT_TRUE(page.drain().empty()) << "nothing happened";
  const Message after = page.frame_after_steps(1);
  EXPECT_EQ(after.json["step"], 1);
  EXPECT_EQ(after.json["generation"], before.json["generation"]);
}

TEST(ViewerSession, FailuresNameTheCommandTheValueAndWhatIsAllowed) {
  TestPage page(three_balls());
  page.scene();
  page.say({{"do", "speed"}, {"factor", 11}, {"id", 3}});
  const Message failure = page.only(Message::failure);
  EXPECT_EQ(failure.json["id"], 3);
  EXPECT_EQ(failure.json["message"], "speed: factor is 11; it must be a number from 0 to 10");
  EXPECT_EQ(page.failure(R"({"do": "set", "broad_phase": "fast"})"),
            "set: broad_phase is \"fast\"; it must be one of octree, sweep, brute");
  EXPECT_EQ(page.failure(R"({"do": "grab", "object": 7, "vertex": 0})"),
            "grab: there is no object 7; there are 3, numbered from 0");
  EXPECT_EQ(page.failure(R"({"do": "pause", "now": true})"),
            "pause: it has no \"now\"; it takes nothing more");
}

TEST(ViewerSession, WhoDoesNotListenIsNotAnsweredWithoutEnd) {
  TestPage page(three_balls());
  page.scene();
  for (int i = 0; i < 5000; ++i) page.session.command("?");
  const std::vector<Message> messages = page.drain();
  EXPECT_EQ(messages.size(), 256u);
  EXPECT_NE(messages.back().json["message"].get<std::string>().find("passed over"), std::string::npos);
  EXPECT_NO_THROW(page.ask({{"do", "pause"}}));
}

TEST(ViewerSession, APageThatComesAgainGetsAllAfresh) {
  TestPage page(three_balls());
  page.scene();
  page.ask({{"do", "pause"}});
  page.say({{"do", "credit"}, {"frames", 5}});
  page.drain();
  page.session.command("?");
  page.session.greet();
  const Message scene = page.scene();  // the failure was the other page's, and so was the credit
  EXPECT_EQ(scene.json["generation"], 2);
  const Message frame = page.frame();
  EXPECT_EQ(frame.json["generation"], 2);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(frame.has(32, i));
}

TEST(ViewerSession, KeepsUpWithTimeAndGivesUpWhatItCannotCatchUpWith) {
  TestPage page(three_balls());
  page.scene();
  Session& session = page.session;
  EXPECT_NEAR(session.advance(0.004), 0.006, 1e-12);
  EXPECT_EQ(page.frame().json["step"], 0);
  EXPECT_NEAR(session.advance(0.006), 0.01, 1e-12);
  EXPECT_EQ(page.frame().json["step"], 1);
  // Ten steps late: one now, one at once, and then it goes on as usual.
  EXPECT_EQ(session.advance(0.1), 0);
  EXPECT_EQ(session.advance(0), 0.01);
  EXPECT_NEAR(session.advance(0), 0.01, 1e-12);
  EXPECT_EQ(page.frame().json["step"], 3);
  page.ask({{"do", "speed"}, {"factor", 0.5}});
  EXPECT_NEAR(session.advance(0), 0.02, 1e-12);
  page.ask({{"do", "speed"}, {"factor", 0}});
  EXPECT_EQ(session.advance(0), 0);
  EXPECT_EQ(session.advance(0), 0);
  EXPECT_EQ(page.frame().json["step"], 5);
  page.ask({{"do", "pause"}});
  EXPECT_GT(session.advance(0.1), 0.1);
  EXPECT_EQ(page.frame().json["playing"], false);
  EXPECT_GT(session.advance(0.1), 0.1);
  page.say({{"do", "credit"}, {"frames", 1}});
  EXPECT_TRUE(page.drain().empty());
  page.ask({{"do", "step"}, {"count", 3}});
  EXPECT_EQ(session.advance(0), 0);
  EXPECT_EQ(session.advance(0), 0);
  EXPECT_GT(session.advance(0), 0);
  EXPECT_GT(session.advance(0), 0);
  EXPECT_EQ(page.frame().json["step"], 8);
  page.ask({{"do", "step"}, {"count", 3}});
  session.advance(0);
  page.ask({{"do", "pause"}});  // gives up the rest
  session.advance(0);
  EXPECT_EQ(page.frame().json["step"], 9);
}

TEST(ViewerSession, ObjectsWithoutMotionArePaused) {
  Show show;
  show.objects = {test_ball("a", {}), test_ball("b", {1.5, 0, 0})};
  TestPage page(show);
  page.scene();
  page.session.advance(1);
  const Message frame = page.frame();
  EXPECT_EQ(frame.json["playing"], false);
  EXPECT_EQ(frame.json["step"], 0);
  EXPECT_GT(frame.section(34).count, 0u);
}

TEST(ViewerSession, SetChangesEachOptionAndStartsAnew) {
  TestPage page(three_balls());
  page.scene();
  page.ask({{"do", "pause"}});
  page.frame_after_steps(5);
  const std::vector<std::pair<std::string, Json>> options{{"bounding_volume", "sphere"},
                                                          {"max_level", 2},
                                                          {"leaf_size", 8},
                                                          {"integrator", "backward_euler"},
                                                          {"integrator", "symplectic_euler"},
                                                          {"broad_phase", "sweep"},
                                                          {"broad_phase", "brute"},
                                                          {"contacts", "continuous"},
                                                          {"contacts", "none"},
                                                          {"time_step", 0.005}};
  int generation = 1;
  for (const auto& [name, value] : options) {
    page.say({{"do", "set"}, {name, value}, {"id", 1}});
    const std::vector<Message> messages = page.drain();
    ASSERT_EQ(messages.size(), 2u) << name;
    const Message& scene = messages.front();
    ASSERT_EQ(scene.kind, Message::scene);
    EXPECT_EQ(scene.json[name], value);
    EXPECT_EQ(scene.json["generation"], ++generation);
    EXPECT_EQ(messages.back().kind, Message::answer);
    const Message frame = page.frame();
    EXPECT_EQ(frame.json["step"], 0);
    EXPECT_EQ(frame.json["playing"], false);
    for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(frame.has(32, i));
    EXPECT_EQ(page.frame_after_steps(2).json["step"], 2);
  }
  page.say({{"do", "set"}});  // all of them stay
  const Message scene = page.scene();
  EXPECT_EQ(scene.json["bounding_volume"], "sphere");
  EXPECT_EQ(scene.json["leaf_size"], 8);
  EXPECT_EQ(scene.json["time_step"], 0.005);
}

TEST(ViewerSession, RepeatsObjectsApartAndCutsTheList) {
  Show show = three_balls();
  show.simulation.border = Border{{{-2, -2, -2}, {5, 2, 4}}};
  TestPage page(show);
  page.scene();
  page.say({{"do", "set"}, {"objects", 14}});
  Message scene = page.scene();
  ASSERT_EQ(scene.json["objects"].size(), 14u);
  EXPECT_EQ(scene.json["objects"][3]["name"], "waves #2");
  EXPECT_EQ(scene.json["objects"][13]["name"], "soft #5");
  EXPECT_EQ(scene.json["objects"][13]["body"], true);
  EXPECT_TRUE(page.frame().values<Pair>(33).empty()) << "they are apart, as the three are";
  EXPECT_NO_THROW(page.frame_after_steps(20));
  page.say({{"do", "set"}, {"objects", 2}});
  scene = page.scene();
  ASSERT_EQ(scene.json["objects"].size(), 2u);
  page.say({{"do", "set"}, {"objects", 3}});
  EXPECT_EQ(page.scene().json["objects"][2]["name"], "rest");
}

TEST(ViewerSession, ResetStartsAnewWithTheSeed) {
  Show show = three_balls();
  show.objects[1].motion = MassSpringMotion{.random_speed = 1};
  TestPage page(show);
  page.scene();
  page.ask({{"do", "pause"}});
  const auto positions = [&] { return page.frame_after_steps(10).values<Vec3f>(32, 1); };
  const auto reset = [&](Json command) {
    command["do"] = "reset";
    page.say(command);
    return page.scene();
  };
  const auto first = positions();
  EXPECT_EQ(reset({}).json["seed"], 0);
  EXPECT_EQ(positions(), first);
  EXPECT_EQ(reset({{"seed", 5}}).json["seed"], 5);
  const auto other = positions();
  EXPECT_NE(other, first);
  EXPECT_EQ(reset({}).json["seed"], 5);
  EXPECT_EQ(positions(), other);
}

TEST(ViewerSession, AFailedSetLeavesAllAsItWas) {
  Show show = three_balls();
  show.objects[2] = test_ball("fine", {0, 0, 2.2}, 30);
  TestPage page(show);
  page.scene();
  page.ask({{"do", "pause"}});
  page.frame_after_steps(3);
  const std::string failure =
      page.failure(R"({"do": "set", "objects": 100000, "bounding_volume": "sphere"})");
  EXPECT_EQ(failure.substr(0, 25), "set: 100000 objects have ");
  const Message frame = page.frame_after_steps(1);
  EXPECT_EQ(frame.json["step"], 4);
  EXPECT_EQ(frame.json["generation"], 1);
  page.say({{"do", "set"}});
  const Message scene = page.scene();
  EXPECT_EQ(scene.json["objects"].size(), 3u);
  EXPECT_EQ(scene.json["bounding_volume"], "aabb");
}

TEST(ViewerSession, ABodyThatBlowsUpPausesTheSession) {
  Show show = three_balls();
  show.objects[1].motion =
      MassSpringMotion{.springs = {.vertex_mass = 1e-6, .stiffness = 1e4}, .velocity = {-1, 0, 0}};
  // Out of balance from the start.
  show.objects[1].motion = MassSpringMotion{
      .springs = {.vertex_mass = 1e-6, .stiffness = 1e4}, .random_force = 1, .deform_seconds = 1};
  TestPage page(show);
  page.scene();
  page.frame();
  std::optional<Message> failure;
  for (int i = 0; i < 200 && !failure; ++i) {
    page.session.advance(0.01);
    const std::vector<Message> messages = page.drain();
    if (!messages.empty()) failure = messages.front();
  }
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, Message::failure);
  EXPECT_EQ(failure->json["fatal"], false);
  EXPECT_FALSE(failure->json.contains("id"));
  EXPECT_NE(failure->json["message"].get<std::string>().find("soft"), std::string::npos);
  EXPECT_EQ(page.frame().json["playing"], false);
  EXPECT_FALSE(page.session.ended());
  EXPECT_NO_THROW(page.ask({{"do", "set"}, {"integrator", "backward_euler"}}));
  page.frame_after_steps(20);
}

TEST(ViewerSession, EmptyShowsObjectsAndMeshesAreFine) {
  TestPage nothing(Show{});
  EXPECT_EQ(nothing.scene().json["objects"].size(), 0u);
  EXPECT_EQ(nothing.frame().json["step"], 0);
  EXPECT_EQ(nothing.frame_after_steps(2).json["step"], 2);
  nothing.say({{"do", "set"}, {"objects", 5}});
  EXPECT_EQ(nothing.scene().json["objects"].size(), 0u);

  Show show;
  show.objects.emplace_back().mesh.name = "no vertices";
  show.objects.push_back({TriangleMesh{"points", {{0, 0, 0}, {1, 1, 1}}, {}}});
  show.objects.push_back(test_ball("ball", {}));
  show.objects[0].motion = Sway{.amplitude = 1};
  show.objects[1].motion = Sway{.amplitude = 1};
  TestPage page(show);
  page.scene();
  page.ask({{"do", "layers"},
            {"candidates", true},
            {"scene_regions", true},
            {"colliding_vertices", true},
            {"octree", {{"objects", {0, 1, 2}}, {"level", -1}}}});
  const Message frame = page.frame();
  EXPECT_EQ(frame.section(32, 0).count, 0u);
  EXPECT_EQ(frame.section(32, 1).count, 2u);
  EXPECT_EQ(frame.json["octree_levels"].size(), 3u);
  page.frame_after_steps(3);
  EXPECT_EQ(page.ask({{"do", "read"}, {"object", 0}})["bounds"], nullptr);
}

TEST(ViewerSession, WhatIsNoNumberIsNaN) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinity = std::numeric_limits<double>::infinity();
  Show show;
  show.objects = {test_ball("whole", {}), test_ball("broken", {1.5, 0, 0})};
  show.objects[1].mesh.positions[4] = {1, nan, -infinity};
  show.objects[1].mesh.positions[7] = {1e300, 0, 0};
  TestPage page(show);
  const Message scene = page.scene();
  const auto sent = page.frame().values<Vec3f>(32, 1);
  EXPECT_TRUE(std::isnan(sent[4].y) && std::isnan(sent[4].z));
  // The middle of the bounds is at 5e299: nothing near the others is left, but it is said.
  EXPECT_EQ(scene.json["center"][0], 5e299);
  EXPECT_TRUE(std::isnan(sent[7].x) && std::isnan(sent[0].x));
  EXPECT_EQ(page.ask({{"do", "read"}, {"object", 1}, {"vertex", 4}})["position"],
            (Json{1.0, nullptr, nullptr}));
  EXPECT_FALSE(page.failure(R"({"do": "grab", "object": 1, "vertex": 4})").empty());
}

TEST(ViewerSession, FarAwayFloatsStayPrecise) {
  const Vec3d far{1e7, -2e7, 3e7};
  Show show = touching_balls();
  for (ShowObject& object : show.objects)
    for (Vec3d& p : object.mesh.positions) p = p + far;
  TestPage page(show);
  const Message scene = page.scene();
  const Vec3d center = center_of(scene);
  const auto sent = page.frame().values<Vec3f>(32, 1);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const Vec3d p = show.objects[1].mesh.positions[i];
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(center[axis] + sent[i][axis], p[axis], 1e-7);
  }
  for (const auto& corner : scene.json["bounds"])
    for (const double x : corner) EXPECT_LT(std::fabs(x), 4);
}

TEST(ViewerSession, ReadsVerticesTrianglesAndObjects) {
  TestPage page(touching_balls());
  page.scene();
  const TriangleMesh ball = test_ball("", {1.5, 0, 0}).mesh;
  const Json vertex = page.ask({{"do", "read"}, {"object", 1}, {"vertex", 9}});
  EXPECT_EQ(vertex["position"], (Json{ball.positions[9].x, ball.positions[9].y, ball.positions[9].z}));

  const Message frame = page.frame();
  const auto contacts = frame.values<std::array<std::uint32_t, 8>>(34);
  ASSERT_FALSE(contacts.empty());
  const std::uint32_t triangle = contacts.front()[3];
  Json expected = Json::array();
  for (const auto& c : contacts)
    if (c[3] == triangle) expected.push_back({c[0], c[1]});
  const Json answer = page.ask({{"do", "read"}, {"object", 1}, {"triangle", triangle}});
  EXPECT_EQ(answer["vertices"], Json(ball.triangles[triangle]));
  EXPECT_EQ(answer["contacts"], expected);
  EXPECT_EQ(answer["contact_count"], expected.size());
  EXPECT_GT(answer["area"], 0.0);
  const Vec3d n{answer["normal"][0], answer["normal"][1], answer["normal"][2]};
  EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1, 1e-12);

  const Json object = page.ask({{"do", "read"}, {"object", 1}});
  EXPECT_EQ(object["name"], "right");
  EXPECT_EQ(object["triangles"], 180);
  EXPECT_EQ(object["contact_count"], contacts.size());
  EXPECT_GE(object["octree"]["leaves"], 3);
  double highest = -2;
  for (const Vec3d& p : ball.positions) highest = std::max(highest, p.y);
  EXPECT_EQ(object["bounds"][1][1], highest);
}

TEST(ViewerSession, NamesThatAreNoUtf8AreMended) {
  Show show;
  show.title = "caf\xc3\xa9 \xff";
  show.objects = {test_ball("\xc3(\x80", {})};
  TestPage page(show);
  const Message scene = page.scene();
  EXPECT_EQ(scene.json["title"], "caf\xc3\xa9 \xef\xbf\xbd");
  EXPECT_EQ(scene.json["objects"][0]["name"], "\xef\xbf\xbd(\xef\xbf\xbd");
}

TEST(ViewerSession, RefusesWhatAnObjectMustNotBe) {
  Show show = three_balls();
  show.objects[0].motion = Sway{.wavelength = 0};
  EXPECT_THROW(TestPage{show}, Error);
  show = three_balls();
  show.objects[0].mesh.triangles[5][1] = 92;
  EXPECT_THROW(TestPage{show}, Error);
  show = three_balls();
  show.simulation.time_step = 0;
  EXPECT_THROW(TestPage{show}, Error);
}

}  // namespace
}  // namespace supple::viewer
