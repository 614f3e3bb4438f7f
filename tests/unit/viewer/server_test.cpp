#include "server/server.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "session/scene_view.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "support/eventually.hpp"
#include "unit/viewer/page_client.hpp"

namespace supple::viewer {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

using Kind = ViewerMessage::Kind;
constexpr std::string_view page = "<!doctype html><title>The page</title>";

/// Two deformable boxes.
SceneView small_show() {
  SceneView show;
  show.title = "small";
  show.simulation.scene.threads = 1;
  for (int i = 0; i < 2; ++i) {
    MassSpringMotion motion;
    motion.random_speed = 0.1;
    show.objects.push_back({make_box({1, 1, 1}, 2), {}, motion});
  }
  return show;
}

class ViewerServer : public testing::Test {
 protected:
  ViewerServer() { alarm(120); }  // a test that never ends is a failure
  ~ViewerServer() override {
    end();
    alarm(0);
  }

  void start(SceneView show = small_show(), std::chrono::milliseconds patience = 30s, Drawing drawing = {}) {
    server_.emplace(Session(std::move(show)),
                    ServerOptions{.page = page, .patience = patience, .drawing = drawing});
    thread_ = std::thread([this] {
      try {
        server_->run([this] { return should_end_.load(); });
      } catch (const std::exception& error) {
        failure_ = error.what();
      }
      has_ended_ = true;
    });
  }
  void end() {
    should_end_ = true;
    if (thread_.joinable()) thread_.join();
    server_.reset();
  }

  std::uint16_t port() const { return server_->port(); }
  PageClient connect() { return PageClient(port(), server_->token()); }
  std::string with_token(const std::string& path) const { return path + "?token=" + server_->token(); }
  std::string own_host() const { return "127.0.0.1:" + std::to_string(port()); }

  std::string failure_;
  std::atomic<bool> has_ended_ = false;

 private:
  std::optional<Server> server_;
  std::thread thread_;
  std::atomic<bool> should_end_ = false;
};

TEST_F(ViewerServer, PageNeedsTheToken) {
  start();
  const Answer answer = get(port(), with_token("/"));
  EXPECT_EQ(answer.status, 200u);
  EXPECT_EQ(answer.body, page);
  for (const std::string target : {"/", "/?token=", "/?token=0123456789abcdef0123456789abcdef"}) {
    const Answer refusal = get(port(), target);
    EXPECT_EQ(refusal.status, 403u) << target;
    EXPECT_NE(refusal.body.find("supple view"), std::string::npos) << "does not help: " << refusal.body;
    EXPECT_EQ(refusal.body.find("The page"), std::string::npos);
  }
}

TEST_F(ViewerServer, UrlIsWhatOneOpens) {
  start();
  const Server other(Session(small_show()), {"127.0.0.1", 0, page});
  EXPECT_EQ(other.url(), "http://127.0.0.1:" + std::to_string(other.port()) + "/?token=" + other.token());
  EXPECT_EQ(get(port(), "/?token=" + other.token()).status, 403u) << "each server has its own token";
}

TEST_F(ViewerServer, PageIsNotKeptNorFramedNorMayItLoadAnything) {
  start();
  for (const char* const target : {"/", "/nothing"}) {
    auto fields = get(port(), with_token(target)).fields;
    EXPECT_EQ(fields["Cache-Control"], "no-store");
    EXPECT_EQ(fields["X-Content-Type-Options"], "nosniff");
    EXPECT_EQ(fields["Referrer-Policy"], "no-referrer");
    const std::string policy = fields["Content-Security-Policy"];
    for (const std::string part :
         {"default-src 'none'", "frame-ancestors 'none'", "connect-src 'self' ws://"})
      EXPECT_NE(policy.find(part), std::string::npos) << policy;
    EXPECT_EQ(policy.find('*'), std::string::npos) << policy;
  }
}

TEST_F(ViewerServer, ThereIsNothingElse) {
  start();
  for (const std::string path : {"/favicon.ico", "/index.html", "/../etc/passwd", "/session", "//"})
    EXPECT_EQ(get(port(), with_token(path)).status, 404u) << path;
}

TEST_F(ViewerServer, OtherMethodsAreRefused) {
  start();
  const std::string rest = " HTTP/1.1\r\nHost: " + own_host() + "\r\n\r\n";
  for (const std::string method : {"PUT ", "DELETE ", "OPTIONS "})
    EXPECT_EQ(ask(port(), method + with_token("/") + rest).status, 405u) << method;
  const Answer head = ask(port(), "HEAD " + with_token("/") + rest, true);
  EXPECT_EQ(head.status, 200u);
  EXPECT_EQ(head.body, "");
  EXPECT_EQ(head.fields.at("Content-Length"), std::to_string(page.size()));
}

TEST_F(ViewerServer, HostMustBeItself) {
  start();
  const std::string number = ":" + std::to_string(port());
  EXPECT_EQ(get(port(), with_token("/"), "localhost" + number).status, 200u);
  for (const std::string& host : {std::string(), "evil.example" + number, std::string("127.0.0.1"),
                                  std::string("127.0.0.1:1"), "127.0.0.1.evil.example" + number}) {
    const Answer refusal = get(port(), with_token("/"), host);
    EXPECT_EQ(refusal.status, 403u) << host;
    EXPECT_NE(refusal.body.find(own_host()), std::string::npos) << refusal.body;
  }
}

TEST_F(ViewerServer, WhatIsNoRequestIsRefused) {
  start();
  EXPECT_EQ(ask(port(), "\x16\x03\x01 hello\r\n\r\n").status, 400u);
  EXPECT_EQ(ask(port(), "GET / HTTP/1.1\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n").status, 413u);
  EXPECT_EQ(get(port(), with_token("/")).status, 200u) << "the server continues";
}

TEST_F(ViewerServer, SlowConnectionsDoNotKeepNewClientsOut) {
  rlimit files{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &files), 0);
  files.rlim_cur = std::min<rlim_t>(files.rlim_max, 4096);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
  start();
  const std::size_t count = std::min<std::size_t>(1000, files.rlim_cur - 200);
  boost::asio::io_context context;
  std::vector<boost::asio::ip::tcp::socket> slow;
  const std::string begin = "GET " + with_token("/") + " HTTP/1.1\r\nHost: " + own_host() + "\r\n";
  for (std::size_t i = 0; i < count; ++i) {
    slow.emplace_back(context).connect({boost::asio::ip::make_address("127.0.0.1"), port()});
    boost::system::error_code may_be_dropped;
    boost::asio::write(slow.back(), boost::asio::buffer(begin), may_be_dropped);
  }
  const auto is_closed = [](boost::asio::ip::tcp::socket& socket) {
    pollfd connection{socket.native_handle(), POLLRDHUP, 0};
    return poll(&connection, 1, 0) == 1;
  };
  // The newest one may still end its request.
  boost::asio::write(slow.back(), boost::asio::buffer("\r\n", 2));
  std::string answer;
  boost::system::error_code end_of_answer;
  boost::asio::read(slow.back(), boost::asio::dynamic_buffer(answer), end_of_answer);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;

  EXPECT_EQ(get(port(), with_token("/")).status, 200u);
  EXPECT_EQ(connect().receive().kind, Kind::scene);
  EXPECT_TRUE(eventually([&] { return std::ranges::count_if(slow, is_closed) + 16 >= std::ssize(slow); }));
}

TEST_F(ViewerServer, SessionNeedsTokenHostAndOrigin) {
  start();
  const std::string token = with_token("").substr(7), host = own_host();
  const auto is_let_in = [&](const std::string& given_token, const std::string& given_host,
                             const std::string& origin, const std::string& path = "/session") {
    try {
      PageClient client(port(), given_token, given_host, origin, path);
      return client.receive().kind == Kind::scene;
    } catch (const boost::system::system_error& error) {
      EXPECT_EQ(error.code(), boost::beast::websocket::error::upgrade_declined);
      return false;
    }
  };
  EXPECT_TRUE(is_let_in(token, host, "http://" + host));
  EXPECT_TRUE(is_let_in(token, host, "")) << "no browser";
  const std::string local = "localhost:" + std::to_string(port());
  EXPECT_TRUE(is_let_in(token, local, "http://" + local));

  EXPECT_FALSE(is_let_in("", host, "http://" + host));
  EXPECT_FALSE(is_let_in(std::string(32, '0'), host, "http://" + host));
  for (const std::string origin : {"null", "http://evil.example", "http://127.0.0.1:1", "file://"})
    EXPECT_FALSE(is_let_in(token, host, origin)) << origin;
  EXPECT_FALSE(is_let_in(token, host, "https://" + host));
  EXPECT_FALSE(is_let_in(token, host, "http://" + local));
  EXPECT_FALSE(is_let_in(token, "evil.example", "http://evil.example"));
  EXPECT_FALSE(is_let_in(token, host, "http://" + host, "/"));
  EXPECT_FALSE(is_let_in(token, host, "http://" + host, "/other"));
}

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

TEST(ViewerServerOptions, SaysWhatIsWrongWithAnAddress) {
  const auto error_of = [](const std::string& address, std::uint16_t port) -> std::string {
    try {
      const Server server(Session(small_show()), {address, port, page});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const Server first(Session(small_show()), {"127.0.0.1", 0, page});
  EXPECT_NE(error_of("127.0.0.1", first.port()).find("Address already in use"), std::string::npos);
  EXPECT_NE(error_of("somewhere", 0).find("somewhere: it is not an IP address"), std::string::npos);
  EXPECT_NE(error_of("203.0.113.1", 0).find("203.0.113.1, port 0: cannot listen"), std::string::npos);
  EXPECT_TRUE(is_loopback("127.0.0.1"));
  EXPECT_TRUE(is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0"));
  EXPECT_THROW(is_loopback("localhost:80"), Error);
}

}  // namespace
}  // namespace supple::viewer
