// Clocks jump: when a machine sleeps, or by a fault. A session treats such times as no time, or as a short
// one.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/viewer_page.hpp"

namespace supple::viewer::clock_test {

/// The step that a session reaches in ten short periods, after one period of `seconds`.
std::uint64_t step_after(double seconds) {
  TestPage page(three_balls());
  page.scene();
  page.frame();
  page.ask({{"do", "play"}});
  const double wait = page.session.advance(seconds);
  EXPECT_TRUE(wait >= 0 && std::isfinite(wait)) << wait;
  for (int i = 0; i < 10; ++i) {
    const double next = page.session.advance(0.004);
    EXPECT_TRUE(next >= 0 && std::isfinite(next)) << next;
  }
  return page.frame().json["step"];
}

TEST(SessionClock, TimesThatAreNegativeOrNoNumbersAreNoTime) {
  const std::uint64_t undisturbed = step_after(0);
  EXPECT_GT(undisturbed, 0u);
  for (const double seconds :
       {-1.0, -1e300, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(step_after(seconds), undisturbed) << seconds;
}

TEST(SessionClock, LongTimesAreShortPauses) {
  const std::uint64_t after_pause = step_after(10);
  EXPECT_LE(after_pause, step_after(0) + 2);
  for (const double seconds : {1e9, 1e300, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(step_after(seconds), after_pause) << seconds;
}

}  // namespace supple::viewer::clock_test
