#include "server/session_thread.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>

#include "attach/gate.hpp"
#include "session/program/program_source.hpp"
#include "supple/models.hpp"
#include "support/eventually.hpp"

namespace supple::viewer::session_thread_test {

/// The thread learns at once that the first page has left and that the next one has come.
TEST(SessionThread, TheNextPageDoesNotTakeOverThePauseOfAProgram) {
  Scene scene;
  scene.add(make_icosphere(2), {.name = "ball"});
  const auto gate = std::make_shared<Gate>(
      AttachOptions{}, Gate::Surroundings{[] { return 0.0; }, [] {}, std::chrono::hours(1)});
  std::promise<void> took, may_go_on;
  int times = 0;
  SessionThread::Listener listener;
  listener.message = [](PageNumber, const Message&) {};
  listener.commands_taken = [&] {
    if (++times > 1) return;
    took.set_value();
    may_go_on.get_future().wait();
  };
  listener.ended = [](std::exception_ptr) {};
  SessionThread thread(Session(view_of_program(scene, gate, "program")), listener);
  thread.page_came(1);
  thread.command(1, R"({"do": "pause"})");
  took.get_future().wait();
  EXPECT_FALSE(gate->state().runs);
  thread.page_left(1);
  thread.page_came(2);
  may_go_on.set_value();
  EXPECT_TRUE(eventually([&] { return gate->state().runs; }));
}

}  // namespace supple::viewer::session_thread_test
