#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "../../support/viewer_page.hpp"

namespace supple::viewer::session_commands_test {

TEST(ViewerCommands, WhatIsNotUnderstoodIsAFailureAndDoesNothing) {
  TestPage page(three_balls());
  page.scene();
  page.ask({{"do", "pause"}});
  const ViewerMessage before = page.frame();
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
      R"({"do": "step", "count": "1"})",
      R"({"do": "speed"})",
      R"({"do": "speed", "factor": 11})",
      R"({"do": "speed", "factor": 0.05})",
      R"({"do": "speed", "factor": -1})",
      R"({"do": "speed", "factor": null})",
      R"({"do": "loop"})",
      R"({"do": "loop", "on": true, "from": 1})",
      R"({"do": "loop", "on": true, "from": 2, "to": 1})",
      R"({"do": "seek"})",
      R"({"do": "seek", "frame": 1})",
      R"({"do": "layers", "candidates": 1})",
      R"({"do": "layers", "octree": 3})",
      R"({"do": "layers", "octree": {"objects": [3], "level": 1}})",
      R"({"do": "layers", "octree": {"objects": [0]}})",
      R"({"do": "layers", "octree": {"objects": [0.5], "level": 1}})",
      R"({"do": "layers", "octree": {"objects": [0], "level": -2}})",
      R"({"do": "layers", "octree": {"objects": [0], "level": 1, "colour": 2}})",
      R"({"do": "reset", "seed": 5})",
      R"({"do": "reset", "seed": "-1"})",
      R"({"do": "reset", "seed": "0.5"})",
      R"({"do": "reset", "seed": ""})",
      R"({"do": "reset", "seed": " 1"})",
      R"({"do": "reset", "seed": "18446744073709551616"})",
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
    EXPECT_LT(failure.size(), 500u) << shown;
    EXPECT_EQ(failure.find('\n'), std::string::npos) << shown;
  }
  page.say({{"do", "credit"}, {"frames", 1}});
  EXPECT_TRUE(page.drain().empty()) << "the commands had no effect";
  const ViewerMessage after = page.frame_after_steps(1);
  EXPECT_EQ(after.json["step"], 1);
  EXPECT_EQ(after.json["generation"], before.json["generation"]);
}

TEST(ViewerCommands, FailuresNameTheCommandTheValueAndWhatIsAllowed) {
  TestPage page(three_balls());
  page.scene();
  page.say({{"do", "speed"}, {"factor", 11}, {"id", 3}});
  const ViewerMessage failure = page.only(ViewerMessage::failure);
  EXPECT_EQ(failure.json["id"], 3);
  EXPECT_EQ(failure.json["message"], "speed: factor is 11; it must be a number from 0 to 10");
  EXPECT_EQ(page.failure(R"({"do": "set", "broad_phase": "fast"})"),
            "set: broad_phase is \"fast\"; it must be one of automatic, octree, grid, sweep, brute, sweep3");
  EXPECT_EQ(page.failure(R"({"do": "grab", "object": 7, "vertex": 0})"),
            "grab: there is no object 7; there are 3, numbered from 0");
  EXPECT_EQ(page.failure(R"({"do": "pause", "now": true})"),
            "pause: it has no \"now\"; it takes no other members");
}

TEST(ViewerCommands, WhoDoesNotListenIsNotAnsweredWithoutEnd) {
  TestPage page(three_balls());
  page.scene();
  for (int i = 0; i < 5000; ++i) page.session.command("?");
  const std::vector<ViewerMessage> messages = page.drain();
  EXPECT_EQ(messages.size(), 256u);
  EXPECT_NE(messages.back().json["message"].get<std::string>().find("ignored"), std::string::npos);
  EXPECT_NO_THROW(page.ask({{"do", "pause"}}));
}

TEST(ViewerCommands, ReadsVerticesTrianglesAndObjects) {
  TestPage page(touching_balls());
  page.scene();
  const TriangleMesh ball = test_ball("", {1.5, 0, 0}).mesh;
  const Json vertex = page.ask({{"do", "read"}, {"object", 1}, {"vertex", 9}});
  EXPECT_EQ(vertex["position"], (Json{ball.positions[9].x, ball.positions[9].y, ball.positions[9].z}));

  const ViewerMessage frame = page.frame();
  const auto contacts = contacts_in(frame);
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

}  // namespace supple::viewer::session_commands_test
