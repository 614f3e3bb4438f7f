// Pages that only watch what the controlling page gets.

#include "server/spectators.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <list>
#include <string>
#include <thread>

#include "page_client.hpp"
#include "server/server.hpp"
#include "support/viewer_page.hpp"

namespace supple::viewer {
namespace {

/// A waving ball, a ball at rest, and a large one at rest, whose positions fill the buffers of a socket.
SceneView watched() {
  SceneView show = three_balls();
  show.simulation.scene.threads = 1;
  show.objects.push_back(test_ball("large", {10, 0, 0}, 100));
  show.objects[1].motion = {};
  return show;
}

class ViewerSpectators : public testing::Test {
 protected:
  ViewerSpectators() {
    alarm(120);  // a test that never ends is a failure
    thread_ = std::thread([this] { server_.run([this] { return should_end_.load(); }); });
  }
  ~ViewerSpectators() override {
    end();
    alarm(0);
  }
  void end() {
    should_end_ = true;
    if (thread_.joinable()) thread_.join();
  }

  PageClient control() { return {server_.port(), server_.token()}; }
  std::string watching_token() const {
    const std::string url = server_.watching_url();
    return url.substr(url.find('=') + 1);
  }
  PageClient watch() { return {server_.port(), watching_token()}; }
  /// Takes a step and returns its frame.
  ViewerMessage step(PageClient& page) {
    page.send(R"({"do": "step"})");
    return next_frame(page);
  }
  static ViewerMessage next_frame(PageClient& page) {
    page.send(R"({"do": "credit", "frames": 1})");
    return page.receive(ViewerMessage::frame);
  }
  /// The frame of a step, after any others.
  static ViewerMessage frame_of(PageClient& spectator, std::uint64_t step) {
    ViewerMessage frame = spectator.receive(ViewerMessage::frame);
    while (frame.json["step"] != step) frame = spectator.receive(ViewerMessage::frame);
    return frame;
  }

  Server server_{Session(watched()), {.page = "page", .watching_page = "watching"}};

 private:
  std::thread thread_;
  std::atomic<bool> should_end_ = false;
};

TEST_F(ViewerSpectators, SeeWhatTheControllingPageSees) {
  PageClient page = control(), spectator = watch();
  const ViewerMessage scene = page.receive(ViewerMessage::scene);
  page.send(R"({"do": "pause"})");
  const ViewerMessage first = next_frame(page);
  EXPECT_EQ(spectator.receive().json, scene.json);
  const ViewerMessage seen = frame_of(spectator, first.json["step"].get<std::uint64_t>());
  EXPECT_EQ(seen.sections.size(), first.sections.size());
  for (int i = 0; i < 5; ++i) {
    const ViewerMessage frame = step(page);
    const ViewerMessage other = frame_of(spectator, frame.json["step"].get<std::uint64_t>());
    EXPECT_EQ(other.section(34).data, frame.section(34).data);
    EXPECT_EQ(other.section(32, 0).data, frame.section(32, 0).data);
    EXPECT_FALSE(other.has(32, 3)) << "what rests is not sent again";
  }
}

TEST_F(ViewerSpectators, OneThatComesLaterGetsAllPositions) {
  PageClient page = control();
  page.receive(ViewerMessage::scene);
  page.send(R"({"do": "pause"})");
  const ViewerMessage first = next_frame(page);
  ViewerMessage last = first;
  for (int i = 0; i < 3; ++i) last = step(page);
  PageClient spectator = watch();
  EXPECT_EQ(spectator.receive().kind, ViewerMessage::scene);
  const ViewerMessage seen = spectator.receive();
  EXPECT_EQ(seen.json, last.json);
  EXPECT_EQ(seen.section(32, 0).data, last.section(32, 0).data);
  for (const std::uint32_t object : {1u, 2u, 3u})
    EXPECT_EQ(seen.section(32, object).data, first.section(32, object).data);
  EXPECT_EQ(seen.section(34).data, last.section(34).data);
}

TEST_F(ViewerSpectators, CommandsHaveNoEffect) {
  PageClient page = control(), spectator = watch();
  page.receive(ViewerMessage::scene);
  page.send(R"({"do": "pause"})");
  next_frame(page);
  spectator.send(R"({"do": "step", "count": 5, "id": 1})");
  spectator.send(R"({"do": "set", "bounding_volume": "sphere"})");
  EXPECT_EQ(step(page).json["step"], 1);
  EXPECT_EQ(get(server_.port(), "/?token=" + watching_token()).body, "watching");
}

TEST_F(ViewerSpectators, ThereAreNotTooMany) {
  std::list<PageClient> watchers;
  PageClient page = control();
  next_frame(page);
  for (std::size_t i = 0; i < Spectators::most; ++i) {
    watchers.emplace_back(server_.port(), watching_token());
    EXPECT_EQ(watchers.back().receive().kind, ViewerMessage::scene);
  }
  EXPECT_EQ(watch().receive_close(), too_many_spectators);
}

}  // namespace
}  // namespace supple::viewer
