#include "supple/trigonometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace supple::trigonometry_test {

TEST(DeterministicMath, FollowsTheStandardLibrary) {
  const double two_pi = 2 * std::acos(-1.0);
  for (int i = -5000; i <= 5000; ++i) {
    const double turns = i * 0.000731;
    EXPECT_NEAR(sin_turns(turns), std::sin(two_pi * turns), 1e-14);
    EXPECT_NEAR(cos_turns(turns), std::cos(two_pi * turns), 1e-14);
  }
}

TEST(DeterministicMath, QuarterTurnsAreExact) {
  const double sine[] = {0, 1, 0, -1};
  for (int quarter = -8; quarter <= 8; ++quarter) {
    EXPECT_EQ(sin_turns(quarter * 0.25), sine[(quarter + 8) % 4]) << quarter;
    EXPECT_EQ(cos_turns(quarter * 0.25), sine[(quarter + 9) % 4]) << quarter;
  }
}

}  // namespace supple::trigonometry_test
