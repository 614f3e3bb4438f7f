#include "session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../../support/viewer_messages.hpp"
#include "supple/models.hpp"

namespace supple::viewer {
namespace {

using Message = ViewerMessage;

/// All that a page gets at once.
std::vector<Message> drain(Session& session) {
  std::vector<Message> messages;
  for (auto bytes = session.next_message(); !bytes.empty(); bytes = session.next_message())
    messages.emplace_back(bytes);
  return messages;
}

/// The one message that comes.
Message only(Session& session) {
  std::vector<Message> messages = drain(session);
  EXPECT_EQ(messages.size(), 1u);
  if (messages.empty()) throw std::runtime_error("no message came");
  return messages.front();
}

ShowObject ball(const char* name, Vec3d at) {
  ShowObject object{make_icosphere(3)};
  object.options.name = name;
  for (Vec3d& p : object.mesh.positions) p = p + at;
  return object;
}

/// A ball in waves, a soft one that flies towards it, and one that rests.
Show three_balls() {
  Show show;
  show.title = "balls";
  show.objects = {ball("waves", {}), ball("soft", {3, 0, 0}), ball("rest", {0, 0, 1.5})};
  show.objects[0].motion = Sway{.amplitude = 0.05};
  show.objects[1].motion = MassSpringMotion{.velocity = {-1, 0, 0}};
  return show;
}

TEST(ViewerSession, TellsTheSceneAndThenFramesAgainstCredit) {
  Session session(three_balls());
  EXPECT_TRUE(drain(session).empty());  // nobody was greeted
  session.greet();
  const Message scene = only(session);
  ASSERT_EQ(scene.kind, Message::scene);
  EXPECT_EQ(scene.json["title"], "balls");
  EXPECT_EQ(scene.json["source"], "simulation");
  EXPECT_EQ(scene.json["generation"], 1);
  ASSERT_EQ(scene.json["objects"].size(), 3u);
  EXPECT_EQ(scene.json["objects"][1]["name"], "soft");
  EXPECT_EQ(scene.json["objects"][1]["body"], true);
  EXPECT_EQ(scene.values<Triangle>(16, 2), make_icosphere(3).triangles);
  EXPECT_TRUE(drain(session).empty());  // no credit

  session.command(R"({"do": "credit", "frames": 2})");
  const Message first = only(session);  // and nothing new after it
  ASSERT_EQ(first.kind, Message::frame);
  EXPECT_EQ(first.json["step"], 0);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(first.has(32, i));
  session.advance(0.01);
  const Message second = only(session);
  EXPECT_EQ(second.json["step"], 1);
  EXPECT_TRUE(second.has(32, 0) && second.has(32, 1));
  EXPECT_FALSE(second.has(32, 2)) << "what rests is not sent again";
  session.advance(0.01);
  EXPECT_TRUE(drain(session).empty());
}

TEST(ViewerSession, SendsTheNewestStateOnly) {
  Session session(three_balls());
  session.greet();
  only(session);
  for (int i = 0; i < 20; ++i) session.advance(0.01);
  session.command(R"({"do": "credit", "frames": 8})");
  EXPECT_EQ(only(session).json["step"], 20);
}

}  // namespace
}  // namespace supple::viewer
