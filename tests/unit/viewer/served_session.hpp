#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "server/server.hpp"
#include "session/scene_view.hpp"
#include "supple/models.hpp"
#include "unit/viewer/page_client.hpp"

namespace supple::viewer {

using Kind = ViewerMessage::Kind;
inline constexpr std::string_view page = "<!doctype html><title>The page</title>";

/// Two deformable boxes.
inline SceneView small_show() {
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

  void start(SceneView show = small_show(), std::chrono::milliseconds patience = std::chrono::seconds(30),
             Drawing drawing = {}) {
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

}  // namespace supple::viewer
