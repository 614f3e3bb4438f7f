#include "attach/gate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "unit/viewer/watched_program.hpp"

namespace supple::viewer::gate_test {

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
  EXPECT_EQ(count_of(frames_[0], "object_pairs"), 0u) << "the pair filter of the program excludes the pair";
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

TEST_F(WatchedProgram, APageThatWaitsGetsAFrameWhateverTheBudgetSays) {
  attach({.max_slowdown = 0});
  seconds_of_frame_ = 0.5;
  turn();
  give_credit();
  turn();
  for (std::size_t count = 1; count <= 3; ++count) {
    run(1);
    ASSERT_TRUE(until([&] { return frames_.size() == count && !is_running_; })) << count;
    give_credit();
    turn();
    run(3);  // less than two seconds later: nothing is affordable
    ASSERT_TRUE(eventually([&] { return !is_running_; }));
    EXPECT_EQ(frames_.size(), count);
    seconds_ = 3.0 * static_cast<double>(count);
  }
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
  EXPECT_GT(count_of(live.at(24), "contacts"), 0u);
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
    EXPECT_EQ(columns_of(past), columns_of(live.at(step)));
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

}  // namespace supple::viewer::gate_test
