#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "export/embedded.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/viewer.hpp"
#include "support/eventually.hpp"
#include "unit/viewer/page_client.hpp"

namespace supple::viewer::attach_test {

using Kind = ViewerMessage::Kind;

/// A program with one ball, which runs in a thread of its own, and pages that connect to it.
class Attach : public testing::Test {
 protected:
  ~Attach() override {
    if (view_) view_->close();
    ends_ = true;
    if (program_.joinable()) program_.join();
  }

  /// False in a build without the page, in which `attach` says so.
  bool start(AttachOptions options = {}) {
    options.open_browser = false;
    if (embedded_page().empty()) {
      EXPECT_THROW(attach(scene_, options), Error);
      return false;
    }
    view_.emplace(attach(scene_, options));
    return true;
  }
  void run() {
    program_ = std::thread([this] {
      while (!ends_) {
        scene_.translate(ball_, {0.001, 0, 0});
        scene_.detect();
        ++steps_;
      }
    });
  }
  PageClient connect() { return connect(view_->url()); }
  PageClient watch() { return connect(view_->watching_url()); }
  static PageClient connect(const std::string& url) {
    const std::size_t colon = url.find(':', 6), slash = url.find('/', colon);
    const auto port = static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1, slash - colon - 1)));
    return PageClient(port, url.substr(url.find('=') + 1));
  }
  bool goes_on() {
    const std::uint64_t before = steps_;
    return eventually([&] { return steps_ > before + 2; });
  }
  static ViewerMessage frame(PageClient& page) {
    page.send(R"({"do": "credit", "frames": 1})");
    return page.receive(Kind::frame);
  }

  Scene scene_;
  ObjectId ball_ = scene_.add(make_icosphere(2), {.name = "ball"});
  std::optional<View> view_;
  std::atomic<std::uint64_t> steps_ = 0;
  std::atomic<bool> ends_ = false;
  std::thread program_;
};

TEST_F(Attach, PageGetsFramesOfARunningProgram) {
  if (!start({.title = "balls", .max_slowdown = 1000})) GTEST_SKIP();
  run();
  PageClient page = connect();
  EXPECT_EQ(page.receive(Kind::scene).json["title"], "balls");
  const auto first = frame(page).json["step"].get<std::uint64_t>();
  EXPECT_GT(frame(page).json["step"].get<std::uint64_t>(), first);
  EXPECT_GE(view_->frame_count(), 2u);
  EXPECT_GT(view_->seconds_in_steps(), 0);
}

TEST_F(Attach, PageThatBreaksOffContinuesThePausedProgram) {
  if (!start({.max_slowdown = 1000})) GTEST_SKIP();
  {
    PageClient page = connect();
    page.receive(Kind::scene);
    page.send(R"({"do": "pause", "id": 1})");
    page.receive(Kind::answer);
    run();
    EXPECT_EQ(frame(page).json["playing"], false);
    EXPECT_EQ(steps_, 0u);
    EXPECT_TRUE(view_->is_paused());
  }  // closes the socket without a word
  EXPECT_TRUE(goes_on());
}

TEST_F(Attach, PageThatTakesNothingDoesNotStopTheProgram) {
  if (!start({.max_slowdown = 1000})) GTEST_SKIP();
  PageClient page = connect();
  page.send(R"({"do": "credit", "frames": 8})");
  run();
  EXPECT_TRUE(goes_on());
}

TEST_F(Attach, CloseEndsAPauseAndFreesThePort) {
  if (!start()) GTEST_SKIP();
  PageClient page = connect();
  page.receive(Kind::scene);
  page.send(R"({"do": "pause", "id": 1})");
  page.receive(Kind::answer);
  run();
  frame(page);
  view_->close();
  EXPECT_EQ(page.receive_close(), 4002);
  EXPECT_TRUE(goes_on());
  EXPECT_THROW(connect(), boost::system::system_error);
}

TEST_F(Attach, SpectatorsSeeTheProgramAndControlNothing) {
  if (!start({.max_slowdown = 1000, .spectators = true})) GTEST_SKIP();
  PageClient page = connect(), spectator = watch(), silent = watch();
  const ViewerMessage scene = page.receive(Kind::scene);
  page.send(R"({"do": "pause", "id": 1})");
  page.receive(Kind::answer);
  run();
  frame(page);
  EXPECT_EQ(spectator.receive().json, scene.json);
  EXPECT_EQ(spectator.receive().json["step"], 0);
  spectator.send(R"({"do": "play"})");
  spectator.send(R"({"do": "step", "count": 100})");
  for (int step = 1; step < 5; ++step) {
    page.send(R"({"do": "step"})");
    const ViewerMessage seen = frame(page);
    EXPECT_EQ(seen.json["step"], step) << "a spectator has taken steps";
    ViewerMessage same = spectator.receive(Kind::frame);
    while (same.json["step"] != step) same = spectator.receive(Kind::frame);
    EXPECT_EQ(same.section(32, 0).data, seen.section(32, 0).data);
  }
  view_->close();
  EXPECT_EQ(spectator.receive_close(), 4002);
}

TEST_F(Attach, WithoutSpectatorsThereIsNoSecondAddress) {
  if (!start()) GTEST_SKIP();
  EXPECT_EQ(view_->watching_url(), "");
}

TEST_F(Attach, TokenFileKeepsTheAddress) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "attach_token";
  std::filesystem::remove(file);
  if (!start({.token_file = file.string()})) GTEST_SKIP();
  const std::string token = view_->url().substr(view_->url().find('='));
  view_.reset();
  ASSERT_TRUE(start({.token_file = file.string()}));
  EXPECT_EQ(view_->url().substr(view_->url().find('=')), token);
}

TEST_F(Attach, SceneMayEndBeforeTheView) {
  std::optional<Scene> scene(std::in_place);
  scene->add(make_icosphere(1));
  if (embedded_page().empty()) GTEST_SKIP();
  View view = attach(*scene, {.open_browser = false});
  scene->detect();
  scene.reset();
  EXPECT_EQ(view.step_count(), 1u);
}

TEST_F(Attach, ViewMayEndBeforeTheScene) {
  if (!start()) GTEST_SKIP();
  view_.reset();
  EXPECT_NO_THROW(scene_.detect());
}

TEST_F(Attach, WrongOptions) {
  EXPECT_THROW(attach(scene_, {.max_slowdown = -1}), Error);
  EXPECT_THROW(attach(scene_, {.time_step = -1}), Error);
  EXPECT_THROW(attach(scene_, {.address = "nowhere"}), Error);
}

}  // namespace supple::viewer::attach_test
