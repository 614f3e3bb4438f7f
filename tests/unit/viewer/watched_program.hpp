#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "attach/gate.hpp"
#include "session/program/program_source.hpp"
#include "support/eventually.hpp"
#include "support/viewer_page.hpp"

namespace supple::viewer {

/// A program with two balls, of which one moves to the other by a tenth in each step, and a page that watches
/// it. The program runs in a thread of its own, the session in that of the test.
class WatchedProgram : public testing::Test {
 protected:
  ~WatchedProgram() override {
    if (gate_) gate_->close();
    while (is_running_) turn();
    if (program_.joinable()) program_.join();
  }

  void attach(AttachOptions options = {}) {
    gate_ = std::make_shared<Gate>(
        options,
        Gate::Surroundings{[this] { return seconds_.load(); },
                           [this] { seconds_ = seconds_ + seconds_of_frame_; }, std::chrono::hours(1)});
    scene_.set_observer([gate = gate_](const Scene& scene, const DetectRequest& request) {
      gate->pass(scene, request);
      EXPECT_FALSE(gate->enter()) << "the scene is closed outside of the gate";
    });
    page_.emplace(view_of_program(scene_, gate_, "program"));
  }
  /// The program takes steps in another thread.
  void run(int steps, const DetectRequest& request = {}) {
    if (program_.joinable()) program_.join();
    is_running_ = true;
    program_ = std::thread([this, steps, request] {
      for (int i = 0; i < steps; ++i) {
        scene_.translate(right_, {-0.1, 0, 0});
        scene_.detect(request);
        ++steps_taken_;
      }
      is_running_ = false;
    });
  }
  /// The session works once; keeps its messages.
  void turn() {
    page_->session.advance(0);
    for (ViewerMessage& message : page_->drain()) {
      if (message.kind == ViewerMessage::scene) scenes_.push_back(message);
      if (message.kind == ViewerMessage::frame) frames_.push_back(message);
      if (message.kind == ViewerMessage::answer) answers_.push_back(message);
      if (message.kind == ViewerMessage::failure) failures_.push_back(message);
    }
  }
  bool until(const std::function<bool()>& holds) {
    return eventually([&] {
      turn();
      return holds();
    });
  }
  void say(const Json& command) { page_->say(command); }
  void give_credit() { say({{"do", "credit"}, {"frames", 8}}); }
  std::uint64_t last_step() const { return frames_.back().json["step"].get<std::uint64_t>(); }

  Scene scene_;
  ObjectId left_ = scene_.add(test_ball("left", {}).mesh, {.name = "left"});
  ObjectId right_ = scene_.add(test_ball("right", {3, 0, 0}).mesh, {.name = "right"});
  std::atomic<double> seconds_ = 0;
  double seconds_of_frame_ = 0;  ///< that the clock moves when the program waits
  std::shared_ptr<Gate> gate_;
  std::optional<TestPage> page_;
  std::vector<ViewerMessage> scenes_, frames_, answers_, failures_;
  std::atomic<int> steps_taken_ = 0;
  std::atomic<bool> is_running_ = false;
  std::thread program_;
};

}  // namespace supple::viewer
