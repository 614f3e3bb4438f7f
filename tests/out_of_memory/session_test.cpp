// A session in which an allocation fails reports it or throws `std::bad_alloc`, leaks nothing, and leaves no
// traces in other sessions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "every_allocation.hpp"
#include "support/viewer_page.hpp"

namespace supple::viewer::session_test {

const char* const commands[] = {
    R"({"do": "speed", "factor": 0})",
    R"({"do": "layers", "candidates": true, "scene_regions": true, "octree": {"objects": [0, 1], "level": 0}})",
    R"({"do": "credit", "frames": 1})",
    R"({"do": "explain", "id": 1, "a": [0, 10], "b": [1, 20]})",
    R"({"do": "read", "id": 2, "object": 1})",
    R"({"do": "grab", "object": 1, "vertex": 5})",
    R"({"do": "drag", "to": [0.1, 0.2, 0.3]})",
    R"({"do": "credit", "frames": 1})",
    R"({"do": "release"})",
    R"({"do": "what", "id": 3})",
    R"({"do": )",
    R"({"do": "set", "integrator": "backward_euler", "objects": 4})",
    R"({"do": "measure", "id": 4, "a": 0, "b": 1})",
    R"({"do": "reset"})",
    R"({"do": "credit", "frames": 1})",
};

using Bytes = std::vector<std::byte>;

/// Returns all messages.
std::vector<Bytes> play(const SceneView& show, std::optional<Session>& session) {
  std::vector<Bytes> messages;
  session.emplace(show);
  session->greet();
  MessageWriter writer;
  const auto drain = [&] {
    for (auto bytes = session->next_message(writer); !bytes.empty(); bytes = session->next_message(writer))
      messages.emplace_back(bytes.begin(), bytes.end());
  };
  drain();
  for (const char* const command : commands) {
    session->command(command);
    session->advance(0.02);
    drain();
  }
  return messages;
}

/// The texts of the messages.
std::vector<std::string> texts_of(const std::vector<Bytes>& messages) {
  std::vector<std::string> texts;
  for (const Bytes& bytes : messages) texts.push_back(ViewerMessage(bytes).json.dump());
  return texts;
}

bool is_about_memory(const std::string& text) {
  return text.find("not enough memory") != std::string::npos;
}

TEST(SessionOutOfMemory, ReportsOrThrows) {
  SceneView show = three_balls();
  show.simulation.scene.threads = 1;
  std::optional<Session> session;
  const std::vector<std::string> undisturbed = texts_of(play(show, session));
  session.reset();
  ASSERT_GT(undisturbed.size(), 8u);
  std::int64_t reports = 0;
  refuse_every_allocation([&](Refusal& refusal) {
    std::vector<Bytes> messages;
    const bool is_out = refusal.strikes([&] { messages = play(show, session); });
    const std::vector<std::string> texts = texts_of(messages);
    const bool is_reported = std::any_of(texts.begin(), texts.end(), is_about_memory);
    EXPECT_TRUE(is_out || is_reported || texts == undisturbed);
    reports += is_reported;
    session.reset();
    EXPECT_EQ(texts_of(play(show, session)), undisturbed);
    session.reset();
  });
  EXPECT_GT(reports, 0);
}

}  // namespace supple::viewer::session_test
