#include "attach/gate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "session/program/program_source.hpp"
#include "support/eventually.hpp"
#include "support/viewer_page.hpp"

namespace supple::viewer {
namespace {

using namespace std::chrono_literals;

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
    gate_ =
        std::make_shared<Gate>(options, Gate::Surroundings{[this] { return seconds_.load(); }, [] {}, 1h});
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
  std::shared_ptr<Gate> gate_;
  std::optional<TestPage> page_;
  std::vector<ViewerMessage> scenes_, frames_, answers_, failures_;
  std::atomic<int> steps_taken_ = 0;
  std::atomic<bool> is_running_ = false;
  std::thread program_;
};

TEST_F(WatchedProgram, DoesNotWaitForAPageWithoutCredit) {
  attach();
  run(5);
  EXPECT_TRUE(eventually([&] { return !is_running_; }));
  EXPECT_EQ(gate_->state().step_count, 5u);
  EXPECT_EQ(gate_->frame_count(), 0u);
}

TEST_F(WatchedProgram, SceneMessageNeedsNoStep) {
  attach();
  turn();
  ASSERT_EQ(scenes_.size(), 1u);
  const Json& scene = scenes_[0].json;
  EXPECT_EQ(scene["source"], "program");
  EXPECT_EQ(scene["can"], Json::parse(R"(["play", "break", "set"])"));
  EXPECT_EQ(scene["objects"][1]["name"], "right");
  EXPECT_GT(scene["settings"].size(), 0u) << "for its past";
  EXPECT_EQ(scene["breaks"][0], Json::parse(R"({"key": "contact_begin", "doc": "Two objects begin to touch",
                                              "unit": "", "kind": "truth", "value": false})"));
  EXPECT_EQ(scene["break_objects"], Json::parse(R"(["", ""])"));
}

TEST_F(WatchedProgram, FrameIsTheResultOfTheProgram) {
  attach();
  scene_.set_pair_filter([](ObjectId, ObjectId) { return false; });
  turn();
  give_credit();
  turn();
  run(20);
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  EXPECT_EQ(last_step(), 0u);
  EXPECT_EQ(frames_[0].json["playing"], true);
  EXPECT_TRUE(frames_[0].json["break"].is_null());
  EXPECT_EQ(frames_[0].values<Pair>(33).size(), 0u) << "the pair filter of the program excludes the pair";
  EXPECT_TRUE(until([&] { return !is_running_; }));
  EXPECT_EQ(gate_->frame_count(), frames_.size());
}

TEST_F(WatchedProgram, PinsAreMeasuredInStepsWithoutAFrame) {
  attach({.time_step = 0.5});
  turn();
  say({{"do", "pins"}, {"pins", {{{"pin", 4}, {"objects", {1}}}, {{"pin", 5}, {"objects", {0, 1}}}}}});
  run(6);
  ASSERT_TRUE(eventually([&] { return !is_running_; }));
  EXPECT_TRUE(frames_.empty()) << "the page has given no credit";
  say({{"do", "pause"}});
  give_credit();
  run(1);
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  std::vector<std::string> names{"step", "time"};
  for (const Json& value : scenes_[0].json["pin_values"]) names.push_back(value["key"]);
  const auto values = frames_[0].values<double>(63, 4);
  ASSERT_EQ(values.size(), 7 * names.size());
  EXPECT_EQ(frames_[0].values<double>(63, 5).size(), values.size());
  for (std::size_t step = 0; step < 7; ++step) {
    const auto number = [&](const char* name) {
      const auto at = std::find(names.begin(), names.end(), name) - names.begin();
      return values[step * names.size() + static_cast<std::size_t>(at)];
    };
    EXPECT_EQ(number("step"), step);
    EXPECT_EQ(number("time"), 0.5 * static_cast<double>(step));
    EXPECT_NEAR(number("displacement"), 0.1 * static_cast<double>(step + 1), 1e-9);
    if (step == 0)
      EXPECT_TRUE(std::isnan(number("speed")));
    else
      EXPECT_NEAR(number("speed"), 0.2, 1e-9);
  }
}

TEST_F(WatchedProgram, BudgetLimitsFramesAndStatisticsHaveAllSteps) {
  attach({.max_slowdown = 0.5});
  turn();
  give_credit();
  turn();
  // A frame takes one second of this clock, so that the next one must be earned.
  gate_->set_breaks({});
  run(1);
  ASSERT_TRUE(until([&] { return frames_.size() == 1 && !is_running_; }));
  scene_.set_observer(
      [gate = gate_](const Scene& scene, const DetectRequest& request) { gate->pass(scene, request); });
  page_->session.advance(0);
  give_credit();
  turn();
  seconds_ = 0;
  run(4);
  EXPECT_TRUE(until([&] { return !is_running_; }));
  seconds_ = 10;
  give_credit();
  turn();
  run(1);
  ASSERT_TRUE(until([&] { return !is_running_ && last_step() == 5; }));
  const std::size_t width = scenes_[0].json["statistics"].size();
  std::size_t rows = 0;
  for (const ViewerMessage& frame : frames_) rows += frame.values<double>(43).size() / width;
  EXPECT_EQ(rows, 6u) << "of steps without a frame, too";
}

TEST_F(WatchedProgram, PauseStepAndContinue) {
  attach();
  turn();
  give_credit();
  say({{"do", "pause"}});
  turn();
  run(10);
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  EXPECT_EQ(frames_[0].json["playing"], false);
  EXPECT_EQ(last_step(), 0u);
  for (int i = 0; i < 100; ++i) turn();
  EXPECT_EQ(steps_taken_, 0) << "the first step waits";
  say({{"do", "step"}, {"count", 3}});
  ASSERT_TRUE(until([&] { return last_step() == 3; }));
  EXPECT_EQ(steps_taken_, 3);
  say({{"do", "play"}});
  EXPECT_TRUE(until([&] { return !is_running_; }));
  EXPECT_EQ(steps_taken_, 10);
}

TEST_F(WatchedProgram, QuestionsAreAnsweredFromTheSceneInAPause) {
  attach();
  turn();
  give_credit();
  say({{"do", "pause"}});
  turn();
  run(1);
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  say({{"do", "explain"}, {"id", 1}, {"a", {0, 0}}, {"b", {1, 0}}});
  say({{"do", "read"}, {"id", 2}, {"object", 1}, {"vertex", 0}});
  say({{"do", "measure"}, {"id", 3}, {"a", 0}, {"b", 1}});
  say({{"do", "layers"}, {"octree", {{"objects", {0, 1}}, {"level", 1}}}, {"candidates", true}});
  give_credit();
  ASSERT_TRUE(until([&] { return answers_.size() == 3 && frames_.size() == 2; }));
  EXPECT_EQ(answers_[0].json["stage"], "object_volumes");
  const Vec3d at = scene_.position(right_, 0);
  EXPECT_EQ(answers_[1].json["position"], Json({at.x, at.y, at.z}));
  EXPECT_TRUE(frames_[1].has(40, 0));
}

TEST_F(WatchedProgram, QuestionsWaitForTheNextStepOfARunningProgram) {
  attach();
  turn();
  say({{"do", "read"}, {"id", 1}, {"object", 0}});
  turn();
  EXPECT_TRUE(answers_.empty());
  run(1);
  ASSERT_TRUE(until([&] { return !answers_.empty(); }));
  EXPECT_EQ(answers_[0].json["name"], "left");
  EXPECT_TRUE(until([&] { return !is_running_; }));
}

TEST_F(WatchedProgram, BreakSaysWhatAndWhere) {
  attach();
  turn();
  give_credit();
  say({{"do", "break"}, {"contact_begin", true}});
  turn();
  run(30);
  ASSERT_TRUE(until([&] {
    give_credit();  // for frames of the steps before
    return !frames_.empty() && !frames_.back().json["playing"];
  }));
  const Json& found = frames_.back().json["break"];
  EXPECT_EQ(found["event"], "contact_begin");
  EXPECT_EQ(found["text"], "left begins to touch right");
  EXPECT_EQ(found["objects"], Json({0, 1}));
  EXPECT_TRUE(found["point"].is_array());
  EXPECT_EQ(scene_.result().contact_events.begin.size(), 1u) << "the program waits in this step";
  give_credit();
  say({{"do", "play"}});
  EXPECT_TRUE(until([&] { return !is_running_; }));
  EXPECT_EQ(steps_taken_, 30);
}

TEST_F(WatchedProgram, RefusesABreakThatNeverHappens) {
  attach();
  turn();
  give_credit();
  run(1);
  ASSERT_TRUE(until([&] { return !is_running_; }));
  say({{"do", "break"}, {"depth_above", 0.1}});
  ASSERT_TRUE(until([&] { return !failures_.empty(); }));
  EXPECT_NE(failures_[0].json["message"].get<std::string>().find("does not detect penetration"),
            std::string::npos);
  EXPECT_THROW(gate_->set_breaks({.depth_above = 1}), Error);
  EXPECT_NO_THROW(gate_->set_breaks({.contact_begin = true, .intersection = true}));
}

/// The past of a program is detected again from the positions that the program had.
TEST_F(WatchedProgram, ShowsItsPast) {
  attach({.max_slowdown = 1e9});
  turn();
  say({{"do", "pause"}});
  give_credit();
  turn();
  run(40);
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  for (std::uint64_t step = 1; step < 25; ++step) {
    give_credit();
    say({{"do", "step"}});
    ASSERT_TRUE(until([&] { return last_step() == step; }));
  }
  std::map<std::uint64_t, ViewerMessage> live;
  for (const ViewerMessage& frame : frames_) live.emplace(frame.json["step"].get<std::uint64_t>(), frame);
  EXPECT_GT(live.at(24).section(34).count, 0u);
  const auto look_at = [&](std::uint64_t step) {
    frames_.clear();
    give_credit();
    say({{"do", "seek"}, {"frame", step}});
    ASSERT_TRUE(until([&] { return !frames_.empty() && last_step() == step; }));
  };
  for (const std::uint64_t step : {3u, 22u, 15u}) {
    look_at(step);
    const ViewerMessage& past = frames_.back();
    EXPECT_EQ(past.json["past"], true);
    EXPECT_EQ(past.json["range"], Json({0, 24}));
    for (const std::uint32_t tag : {33u, 34u, 35u}) {
      ASSERT_EQ(past.has(tag), live.at(step).has(tag)) << tag;
      if (past.has(tag)) {
        EXPECT_EQ(past.section(tag).data, live.at(step).section(tag).data) << tag;
      }
    }
    EXPECT_EQ(past.section(32, 1).count, scene_.vertex_count(right_));
  }
  EXPECT_EQ(steps_taken_, 24) << "the program waits meanwhile";

  scenes_.clear();
  say({{"do", "set"}, {"bounding_volume", "sphere"}});
  ASSERT_TRUE(until([&] { return !scenes_.empty(); }));
  EXPECT_EQ(scenes_[0].json["bounding_volume"], "sphere");
  EXPECT_TRUE(failures_.empty());
  scenes_.clear();
  say({{"do", "seek"}, {"frame", 24}});
  ASSERT_TRUE(until([&] { return !scenes_.empty(); }));
  EXPECT_EQ(scenes_[0].json["bounding_volume"], "aabb") << "the program has its own options";
  say({{"do", "set"}, {"bounding_volume", "sphere"}});
  ASSERT_TRUE(until([&] { return !failures_.empty(); }));

  look_at(20);
  give_credit();
  say({{"do", "speed"}, {"factor", 0}});
  say({{"do", "play"}});
  EXPECT_TRUE(until([&] {
    give_credit();
    return !is_running_;
  })) << "the past plays up to the present, and then the program goes on";
  EXPECT_EQ(steps_taken_, 40);
}

TEST_F(WatchedProgram, EventsOfStepsWithoutAFrameArrive) {
  attach();
  turn();
  run(60);  // the ball moves through the other one
  ASSERT_TRUE(until([&] { return !is_running_; }));
  run(1);
  ASSERT_TRUE(until([&] {
    give_credit();
    return !is_running_;
  }));
  run(1);
  ASSERT_TRUE(until([&] { return !is_running_ && !frames_.empty(); }));
  std::vector<StepPair> begin, end;
  for (const ViewerMessage& frame : frames_) {
    for (const StepPair& event : frame.values<StepPair>(44)) begin.push_back(event);
    for (const StepPair& event : frame.values<StepPair>(45)) end.push_back(event);
  }
  ASSERT_EQ(begin.size(), 1u);
  ASSERT_EQ(end.size(), 1u);
  EXPECT_GT(begin[0][0], 5u);
  EXPECT_LT(begin[0][0], end[0][0]);
  EXPECT_LT(end[0][0], 60u) << "no frame was sent of this step";
}

TEST_F(WatchedProgram, BreakFromTheProgramDoesNotWaitWithoutAPage) {
  attach({.breaks = {.contact_begin = true}});
  page_->session.leave();
  run(30);
  EXPECT_TRUE(eventually([&] { return !is_running_; }));
}

TEST_F(WatchedProgram, BreakWaitsForAPageWhenTheProgramSaysSo) {
  attach({.wait_for_page = true});
  run(2);
  EXPECT_TRUE(eventually([&] { return gate_->state().step_count == 1; }));
  EXPECT_EQ(steps_taken_, 0) << "the first step waits for its frame";
  turn();
  give_credit();
  EXPECT_TRUE(until([&] { return !is_running_; }));
  EXPECT_GE(gate_->frame_count(), 1u);
}

TEST_F(WatchedProgram, PageThatLeavesContinuesTheProgram) {
  attach();
  turn();
  give_credit();
  say({{"do", "pause"}});
  run(3);
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  EXPECT_EQ(steps_taken_, 0);
  page_->session.leave();
  EXPECT_TRUE(eventually([&] { return !is_running_; }));
  EXPECT_TRUE(gate_->state().runs);
}

TEST_F(WatchedProgram, CloseEndsAPause) {
  attach();
  turn();
  give_credit();
  say({{"do", "pause"}});
  run(3);
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  gate_->close();
  EXPECT_TRUE(until([&] { return !is_running_; }));
}

TEST_F(WatchedProgram, StopEndsAPause) {
  attach();
  turn();
  give_credit();
  say({{"do", "pause"}});
  std::stop_source stop;
  DetectRequest request;
  request.stop = stop.get_token();
  run(1, request);
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  EXPECT_EQ(steps_taken_, 0);
  stop.request_stop();
  EXPECT_TRUE(until([&] { return !is_running_; }));
}

TEST_F(WatchedProgram, ObjectsThatComeAndGoAreANewScene) {
  attach();
  turn();
  give_credit();
  say({{"do", "pause"}});
  run(1);
  ASSERT_TRUE(until([&] { return frames_.size() == 1; }));
  say({{"do", "play"}});
  ASSERT_TRUE(until([&] { return !is_running_; }));
  scene_.remove(left_);
  const ObjectId small =
      scene_.add(test_ball("small", {0, 5, 0}, 1).mesh, {.name = "small", .is_static = true});
  scene_.remove(right_);
  ASSERT_EQ(small.index, 0u);
  say({{"do", "pause"}});
  say({{"do", "layers"}, {"octree", {{"objects", {0, 1}}, {"level", 0}}}});
  give_credit();
  turn();
  if (program_.joinable()) program_.join();
  is_running_ = true;
  program_ = std::thread([this] {
    scene_.detect();
    is_running_ = false;
  });
  ASSERT_TRUE(until([&] { return scenes_.size() == 2; }));
  const Json& objects = scenes_[1].json["objects"];
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0]["name"], "small");
  EXPECT_EQ(objects[0]["static"], true);
  EXPECT_EQ(objects[0]["removed"], false);
  give_credit();
  ASSERT_TRUE(until([&] { return frames_.size() >= 2; }));
  EXPECT_EQ(frames_.back().values<Vec3f>(32, 0).size(), 12u);
  EXPECT_TRUE(failures_.empty());
}

TEST_F(WatchedProgram, PlaceOfARemovedObjectStaysEmpty) {
  attach();
  scene_.remove(left_);
  turn();
  give_credit();
  say({{"do", "pause"}});
  say({{"do", "layers"}, {"octree", {{"objects", {0, 1}}, {"level", 0}}}});
  run(1);
  ASSERT_TRUE(until([&] { return scenes_.size() == 2; }));
  EXPECT_EQ(scenes_[1].json["objects"][0]["removed"], true);
  EXPECT_EQ(scenes_[1].json["objects"][0]["vertices"], 0);
  EXPECT_EQ(scenes_[1].json["objects"][1]["name"], "right");
  give_credit();
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  EXPECT_TRUE(failures_.empty());
}

TEST_F(WatchedProgram, WaitShowsTheLastStepUntilThePageContinues) {
  attach();
  run(2);
  ASSERT_TRUE(eventually([&] { return !is_running_; }));
  program_.join();
  is_running_ = true;
  program_ = std::thread([this] {
    gate_->wait(scene_, {});
    is_running_ = false;
  });
  turn();
  give_credit();
  ASSERT_TRUE(until([&] { return !frames_.empty(); }));
  EXPECT_EQ(last_step(), 1u);
  EXPECT_EQ(frames_[0].json["playing"], false);
  page_->session.leave();
  for (int i = 0; i < 100; ++i) std::this_thread::yield();
  EXPECT_TRUE(is_running_) << "it waits for another page";
  page_->session.greet();
  say({{"do", "play"}});
  EXPECT_TRUE(until([&] { return !is_running_; }));
}

TEST_F(WatchedProgram, CommandsOfOtherSourcesAreRefused) {
  attach();
  turn();
  say({{"do", "reset"}});
  say({{"do", "seek"}, {"frame", 0}});
  say({{"do", "set"}, {"leaf_size", 4}});
  say({{"do", "grab"}, {"object", 0}, {"vertex", 0}});
  say({{"do", "break"}, {"contacts_above", -1}});
  say({{"do", "break"}, {"objects", {"left"}}});
  turn();
  ASSERT_EQ(failures_.size(), 6u);
  for (const ViewerMessage& failure : failures_) EXPECT_EQ(failure.json["fatal"], false);
  EXPECT_EQ(failures_[5].json["message"],
            "break: objects is a list; it must be two names of objects, or empty texts for any object");
}

TEST_F(WatchedProgram, SaysHowLongAgoTheLastStepWas) {
  attach();
  turn();
  run(2);
  ASSERT_TRUE(until([&] { return !is_running_; }));
  seconds_ = 12.5;
  say({{"do", "program"}, {"id", 1}});
  turn();
  ASSERT_EQ(answers_.size(), 1u);
  EXPECT_EQ(answers_[0].json["steps"], 2);
  EXPECT_EQ(answers_[0].json["seconds_since_step"], 12.5);
}

}  // namespace
}  // namespace supple::viewer
