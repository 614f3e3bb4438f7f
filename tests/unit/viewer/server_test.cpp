#include "server/server.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/eventually.hpp"
#include "unit/viewer/served_session.hpp"

namespace supple::viewer::server_test {

using namespace std::chrono_literals;
using nlohmann::json;

TEST_F(ViewerServer, SceneThenFramesAgainstCredit) {
  start();
  PageClient client = connect();
  const ViewerMessage first = client.receive();
  ASSERT_EQ(first.kind, Kind::scene);
  EXPECT_EQ(first.json["title"], "small");
  client.send(R"({"do": "pause"})");
  client.send(R"({"do": "credit", "frames": 1})");
  const ViewerMessage second = client.receive();
  ASSERT_EQ(second.kind, Kind::frame);
  const int step = second.json["step"];
  client.send(R"({"do": "step"})");
  client.send(R"({"do": "credit", "frames": 1})");
  EXPECT_EQ(client.receive(Kind::frame).json["step"], step + 1);
}

TEST_F(ViewerServer, WhatIsNotUnderstoodIsAFailureNotTheEnd) {
  start();
  PageClient client = connect();
  for (const std::string text : {"", "{", "[1]", R"({"do": "fly"})", R"({"do": "seek", "frame": "x"})"}) {
    client.send(text);
    const json answer = client.receive(Kind::failure).json;
    EXPECT_EQ(answer["fatal"], false) << text;
    EXPECT_NE(answer["message"], "");
  }
  client.send(R"({"do": "read", "object": 0, "id": 5})");
  EXPECT_EQ(client.receive(Kind::answer).json["id"], 5);
  client.send("\xff\xfe");  // WebSocket text must be UTF-8
  EXPECT_EQ(client.receive_close(), 1007);
}

TEST_F(ViewerServer, ASecondPageTakesOver) {
  start();
  PageClient first = connect();
  first.receive(Kind::scene);
  PageClient second = connect();
  EXPECT_EQ(second.receive().kind, Kind::scene);
  EXPECT_EQ(first.receive_close(), 4001);
  second.send(R"({"do": "credit", "frames": 1})");
  EXPECT_EQ(second.receive().kind, Kind::frame);
}

TEST_F(ViewerServer, APageThatDoesNotReadIsTakenOverToo) {
  SceneView show = small_show();
  show.objects.push_back({make_cloth(300, 300), {}, WaveMotion{{}, 0.1}});
  start(std::move(show));
  PageClient first = connect();
  first.send(R"({"do": "speed", "factor": 0})");
  first.send(R"({"do": "credit", "frames": 8})");
  first.send(R"({"do": "play"})");
  // The scene is larger than the buffers of the sockets, so the server cannot send all of it.
  ASSERT_TRUE(eventually([&] { return first.socket().next_layer().available() > 0; }));
  PageClient second = connect();
  EXPECT_EQ(second.receive().kind, Kind::scene);
  second.send(R"({"do": "credit", "frames": 1})");
  EXPECT_TRUE(second.receive(Kind::frame).has(32, 2));
}

TEST_F(ViewerServer, OnlyTextsUpToAMegabyteAreCommands) {
  start();
  PageClient binary = connect();
  binary.socket().binary(true);
  binary.send(R"({"do": "pause"})");
  EXPECT_EQ(binary.receive_close(), 4003);

  // The server still parses a text of one mebibyte.
  PageClient large = connect();
  large.send(std::string(std::size_t{1} << 20, ' '));
  EXPECT_EQ(large.receive(Kind::failure).json["fatal"], false);
  large.send(std::string((std::size_t{1} << 20) + 1, ' '));
  EXPECT_EQ(large.receive_close(), 4003);

  PageClient in_pieces = connect();
  in_pieces.receive(Kind::scene);
  boost::system::error_code error;
  for (int i = 0; i < 3000 && !error; ++i)
    in_pieces.socket().write_some(false, boost::asio::buffer(std::string(1000, ' ')), error);
  EXPECT_EQ(in_pieces.receive_close(), 4003);
}

TEST_F(ViewerServer, APageThatDrawsSendsResultsAndIsMissed) {
  std::vector<std::size_t> sizes;
  std::size_t last = 0;
  std::atomic<bool> has_left = false;
  start(small_show(), 30s,
        {[&](std::span<const std::byte> result) {
           sizes.push_back(result.size());
           last = static_cast<std::size_t>(result.back());
         },
         [&] { has_left = true; }});
  {
    PageClient client = connect();
    client.receive(Kind::scene);
    // Larger than any command, between two commands.
    client.send(R"({"do": "pause", "id": 1})");
    client.socket().binary(true);
    client.send(std::string(std::size_t{20} << 20, '\7'));
    client.send("\5");
    client.socket().text(true);
    client.send(R"({"do": "pause", "id": 2})");
    EXPECT_EQ(client.receive(Kind::answer).json["id"], 1);
    EXPECT_EQ(client.receive(Kind::answer).json["id"], 2);
    EXPECT_FALSE(has_left);
  }
  EXPECT_TRUE(eventually([&] { return has_left.load(); }));
  end();
  EXPECT_EQ(sizes, (std::vector<std::size_t>{std::size_t{20} << 20, 1}));
  EXPECT_EQ(last, 5u);
}

TEST_F(ViewerServer, WhatTheProgramThrowsForAResultEndsTheServer) {
  start(small_show(), 30s,
        {[](std::span<const std::byte>) { throw std::runtime_error("the disk is full"); }, [] {}});
  PageClient client = connect();
  client.socket().binary(true);
  client.send("x");
  EXPECT_TRUE(eventually([&] { return has_ended_.load(); }));
  end();
  EXPECT_EQ(failure_, "the disk is full");
}

TEST_F(ViewerServer, MoreCommandsThanMayWaitAreAllCarriedOut) {
  start();
  PageClient client = connect();
  // The commands exceed the server's queue, and each has an answer that the client must read meanwhile.
  const std::string padding(100'000, ' ');
  constexpr int count = 200;
  std::thread sender([&] {
    for (int i = 0; i < count; ++i)
      client.send(R"({"do": "read", "object": 0, "id": )" + std::to_string(i) + padding + "}");
  });
  for (int i = 0; i < count; ++i) EXPECT_EQ(client.receive(Kind::answer).json["id"], i);
  sender.join();
}

TEST_F(ViewerServer, ASlowPageGetsTheNewest) {
  start();
  PageClient client = connect();
  client.send(R"({"do": "speed", "factor": 0})");
  client.send(R"({"do": "play"})");
  client.send(R"({"do": "credit", "frames": 1})");
  const int before = client.receive(Kind::frame).json["step"];
  client.send(R"({"do": "credit", "frames": 0})");  // the page has drawn it
  // The page is busy with other messages. Each answer comes after a step, because the session executes
  // commands between two steps.
  constexpr int steps = 20;
  for (int id = 0; id < steps; ++id) {
    client.send(R"({"do": "read", "object": 0, "id": )" + std::to_string(id) + "}");
    ASSERT_EQ(client.receive(Kind::answer).json["id"], id);
  }
  client.send(R"({"do": "credit", "frames": 1})");
  EXPECT_GE(client.receive(Kind::frame).json["step"], before + steps)
      << "the simulation waits for the page, or frames queue";
}

/// A long recording that counts how often it is read.
class CountedFrames : public Frames {
 public:
  std::uint64_t count() const override { return 1'000'000; }
  void read(std::uint64_t, std::size_t, std::span<Vec3d> positions) const override {
    ++reads;
    std::fill(positions.begin(), positions.end(), Vec3d{});
  }
  const Series& series() const override { return series_; }

  mutable std::atomic<std::uint64_t> reads = 0;

 private:
  Series series_;
};

TEST_F(ViewerServer, TimeStandsStillWhileNobodyLooks) {
  const auto frames = std::make_shared<CountedFrames>();
  SceneView show;
  show.objects.push_back({make_box({1, 1, 1}, 1), {}, {}});
  show.frames = frames;
  start(std::move(show));
  {
    PageClient client = connect();
    client.send(R"({"do": "speed", "factor": 0})");
    client.send(R"({"do": "play"})");
    client.send(R"({"do": "credit", "frames": 1})");
    client.receive(Kind::frame);
    client.send(R"({"do": "credit", "frames": 0})");  // the page has drawn it
    ASSERT_TRUE(eventually([&] { return frames->reads > 20; }));
  }  // the connection ends without a close
  // Between two looks at the count, the server answers requests. They are no pages that look at the session.
  EXPECT_TRUE(eventually([&] {
    const std::uint64_t reads = frames->reads;
    for (int i = 0; i < 20; ++i) EXPECT_EQ(get(port(), with_token("/")).status, 200u);
    return frames->reads == reads;
  }));
}

TEST_F(ViewerServer, APageComesBackToTheSameSession) {
  start();
  int before = 0;
  {
    PageClient client = connect();
    client.send(R"({"do": "speed", "factor": 0})");
    client.send(R"({"do": "play"})");
    client.send(R"({"do": "credit", "frames": 8})");
    before = client.receive(Kind::frame).json["step"];
  }  // the connection ends without a close
  const auto step_of_a_new_page = [&] {
    PageClient client = connect();
    EXPECT_EQ(client.receive().kind, Kind::scene);
    client.send(R"({"do": "pause"})");
    client.send(R"({"do": "credit", "frames": 1})");
    const int step = client.receive(Kind::frame).json["step"];
    for (int id = 0; id < 20; ++id) {
      client.send(R"({"do": "read", "object": 0, "id": )" + std::to_string(id) + "}");
      EXPECT_EQ(client.receive(Kind::answer).json["id"], id);
    }
    return step;
  };
  const int after = step_of_a_new_page();
  EXPECT_GE(after, before);
  EXPECT_EQ(step_of_a_new_page(), after) << "the session is paused";
}

TEST_F(ViewerServer, APageThatGivesNoSignOfLifeIsGivenUp) {
  start(small_show(), 400ms);
  PageClient client = connect();
  client.receive(Kind::scene);
  // The client answers pings only while it reads, so the server closes the connection.
  pollfd connection{client.socket().next_layer().native_handle(), POLLRDHUP, 0};
  ASSERT_EQ(poll(&connection, 1, 60'000), 1);
  EXPECT_NE(client.receive_close(), 4002);
  PageClient alive = connect();
  std::atomic<int> pings = 0;
  alive.socket().control_callback([&](boost::beast::websocket::frame_type type, boost::beast::string_view) {
    if (type == boost::beast::websocket::frame_type::ping) ++pings;
  });
  std::thread ender([&] {
    // The server sends a ping after half of its timeout.
    EXPECT_TRUE(eventually([&] { return pings >= 4; }));
    alive.send(R"({"do": "read", "object": 0, "id": 1})");
  });
  EXPECT_EQ(alive.receive(Kind::answer).json["id"], 1) << "a page that answers pings stays";
  ender.join();
}

TEST_F(ViewerServer, TheEndOfTheProgramIsTold) {
  start();
  PageClient client = connect();
  client.receive(Kind::scene);
  std::thread ender([this] { end(); });
  EXPECT_EQ(client.receive_close(), 4002);
  ender.join();
  EXPECT_EQ(failure_, "");
}

TEST_F(ViewerServer, EndsWithoutAPageAndWithOneThatDoesNotAnswer) {
  start();
  const PageClient client = connect();
  const auto from = std::chrono::steady_clock::now();
  end();
  EXPECT_LT(std::chrono::steady_clock::now() - from, 10s);
}

/// Frames that cannot be read for a reason outside the file.
class BrokenFrames : public Frames {
 public:
  std::uint64_t count() const override { return 2; }
  void read(std::uint64_t frame, std::size_t, std::span<Vec3d> positions) const override {
    if (frame > 0) throw std::runtime_error("out of everything");
    std::fill(positions.begin(), positions.end(), Vec3d{});
  }
  const Series& series() const override { return series_; }

 private:
  Series series_;
};

TEST_F(ViewerServer, AnUnforeseenFailureEndsItWithTheReason) {
  SceneView show;
  show.objects.push_back({make_box({1, 1, 1}, 1), {}, {}});
  show.frames = std::make_shared<BrokenFrames>();
  start(std::move(show));
  PageClient client = connect();
  client.receive(Kind::scene);
  client.send(R"({"do": "seek", "frame": 1})");
  EXPECT_EQ(client.receive_close(), 4004);
  end();
  EXPECT_EQ(failure_, "out of everything");
}

TEST_F(ViewerServer, LargeFramesArriveWhole) {
  SceneView show;
  show.simulation.scene.threads = 1;
  show.objects.push_back({make_cloth(320, 320), {}, WaveMotion{{}, 0.1}});
  const std::size_t vertices = show.objects[0].mesh.positions.size();
  EXPECT_GT(vertices, 100'000u);
  start(std::move(show));
  PageClient client = connect();
  client.send(R"({"do": "speed", "factor": 0})");
  client.send(R"({"do": "play"})");
  int last = -1;
  client.send(R"({"do": "credit", "frames": 4})");
  for (int i = 0; i < 20; ++i) {
    const ViewerMessage received = client.receive(Kind::frame);
    client.send(R"({"do": "credit", "frames": 1})");
    EXPECT_EQ(received.section(32, 0).data.size(), 12 * vertices);
    const int step = received.json["step"];
    EXPECT_GT(step, last);
    last = step;
  }
}

}  // namespace supple::viewer::server_test
