// What pauses a program, and what continues it.

#include <gtest/gtest.h>

#include <stop_token>
#include <thread>

#include "supple/error.hpp"
#include "unit/viewer/watched_program.hpp"

namespace supple::viewer::gate_pause_test {

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

}  // namespace supple::viewer::gate_pause_test
