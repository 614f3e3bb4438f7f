#include "core/float_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random.hpp"

namespace supple::float_rounding_test {

constexpr float inf = std::numeric_limits<float>::infinity();

TEST(FloatRounding, EnclosesAndIsTight) {
  RandomNumbers random(1);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::ldexp(random.uniform(-2, 2), random.between(-160, 126));
    const float below = round_down(value), above = round_up(value);
    ASSERT_LE(below, value);
    ASSERT_GE(above, value);
    ASSERT_LE(above - below, 4 * outward_step(static_cast<float>(value)));
  }
}

TEST(FloatRounding, BeyondTheRangeOfFloat) {
  const float largest = std::numeric_limits<float>::max();
  EXPECT_EQ(round_down(1e300), largest);
  EXPECT_EQ(round_up(1e300), inf);
  EXPECT_EQ(round_down(-1e300), -inf);
  EXPECT_EQ(round_up(-1e300), -largest);
  EXPECT_EQ(round_down(1e-300), 0.0f);
  EXPECT_GT(round_up(1e-300), 0.0f);
  EXPECT_EQ(round_up(0.5), 0.5f);
  EXPECT_EQ(round_down(0.5), 0.5f);
}

}  // namespace supple::float_rounding_test
