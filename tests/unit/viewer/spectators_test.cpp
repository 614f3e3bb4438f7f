// Pages that only watch what the controlling page gets.

#include "server/spectators.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "page_client.hpp"
#include "server/server.hpp"
#include "support/viewer_page.hpp"

namespace supple::viewer::spectators_test {

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
    EXPECT_EQ(columns_of(other), columns_of(frame));
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
  EXPECT_EQ(columns_of(seen), columns_of(last));
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

/// A message that no buffer of a socket holds.
Message large_message(MessageKind kind, int step) {
  const auto writer = std::make_shared<MessageWriter>();
  writer->begin(kind);
  writer->add_text(R"({"step": )" + std::to_string(step) + "}");
  const std::span<Vec3f> positions = writer->add<Vec3f>(Tag::positions, 0, 500'000);
  std::fill(positions.begin(), positions.end(), Vec3f{static_cast<float>(step), 0, 0});
  return {writer->finish(), writer};
}

/// One that reads nothing has one message in the network, and gets the newest one next, however many came.
TEST(ViewerSlowSpectator, MissesFramesAndIsOwedOnlyTheNewest) {
  alarm(120);
  asio::io_context network;
  tcp::acceptor acceptor(network, {asio::ip::make_address("127.0.0.1"), 0});
  Spectators spectators(std::chrono::hours(1));
  auto connected = std::async(std::launch::async, [port = acceptor.local_endpoint().port()] {
    return std::make_unique<PageClient>(port, "");
  });
  tcp::socket socket = acceptor.accept();
  socket.set_option(asio::socket_base::send_buffer_size(1 << 16));
  beast::flat_buffer buffer;
  http::request<http::empty_body> request;
  http::read(socket, buffer, request);
  spectators.accept(beast::tcp_stream(std::move(socket)), request);
  while (connected.wait_for(std::chrono::seconds(0)) != std::future_status::ready) network.poll();
  const std::unique_ptr<PageClient> spectator = connected.get();
  network.poll();
  spectators.relay(large_message(MessageKind::scene, -1));
  for (int step = 0; step < 20; ++step) {
    spectators.relay(large_message(MessageKind::frame, step));
    network.poll();
  }
  std::thread reader([&] {
    EXPECT_EQ(spectator->receive().kind, ViewerMessage::scene);
    const ViewerMessage frame = spectator->receive();
    EXPECT_EQ(frame.json["step"], 19) << "no frame between was kept";
    EXPECT_EQ(frame.values<Vec3f>(32, 0).at(499'999).x, 19);
    network.stop();
  });
  network.run();
  reader.join();
  alarm(0);
}

}  // namespace supple::viewer::spectators_test
