#include "base/interruption.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>

#include "support/eventually.hpp"

namespace supple::cli::interruption_test {

TEST(Interruption, SignalsStopTheCallAndThenEndTheRun) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::atomic<int> overdue = 0;
    Interruption interruption({}, [&](const Interruption& given) { overdue = given.signal(); });
    EXPECT_FALSE(interruption.is_requested());
    auto hold = interruption.hold();
    std::raise(signal);
    EXPECT_EQ(interruption.signal(), signal);
    EXPECT_TRUE(eventually([&] { return interruption.token().stop_requested(); }));
    hold.unlock();
    EXPECT_TRUE(eventually([&] { return overdue == signal; }));
  }
}

TEST(Interruption, ATimeLimitDoesTheSame) {
  std::atomic<bool> is_overdue = false;
  Interruption interruption(1e-6, [&](const Interruption& given) { is_overdue = given.signal() == 0; });
  EXPECT_TRUE(eventually([&] { return interruption.is_late(); }));
  EXPECT_TRUE(interruption.is_requested());
  EXPECT_TRUE(eventually([&] { return is_overdue.load(); }));
}

TEST(Interruption, NothingIsOverdueAfterTheEnd) {
  bool is_overdue = false;
  {
    Interruption interruption({}, [&](const Interruption&) { is_overdue = true; });
    interruption.end();
    std::raise(SIGINT);
  }
  EXPECT_FALSE(is_overdue);
  Interruption unlimited({}, [&](const Interruption&) { is_overdue = true; });
  EXPECT_FALSE(unlimited.is_requested());
}

}  // namespace supple::cli::interruption_test
