#include "simulation/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace supple::random_test {

TEST(Random, GivesTheSameBitsEverywhere) {
  Random random(1, 2);
  EXPECT_EQ(random.next(), 11446999876264359965u);
  EXPECT_EQ(random.next(), 9047282882916087253u);
  EXPECT_EQ(random.uniform(), 0x1.db8db58a72b98p-2);
  const Vec3d direction = random.direction();
  EXPECT_EQ(direction.x, 0x1.892c51938e7a7p-3);
  EXPECT_EQ(direction.y, -0x1.95d83bf8ae341p-3);
  EXPECT_EQ(direction.z, -0x1.ec2045bac62dap-1);
}

TEST(Random, DiffersBetweenSeedsAndStreams) {
  const std::uint64_t first = Random(1, 2).next();
  EXPECT_NE(first, Random(2, 2).next());
  EXPECT_NE(first, Random(1, 3).next());
  EXPECT_NE(first, Random(2, 1).next());
}

TEST(Random, UniformNumbersFillTheInterval) {
  Random random(5);
  constexpr int count = 4000;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / count, 1.0 / 2, 0.02);
  EXPECT_NEAR(squares / count, 1.0 / 3, 0.02);
}

TEST(Random, DirectionsAreUnitVectorsThatFavourNone) {
  Random random(7);
  constexpr int count = 4000;
  Vec3d sum, squares;
  for (int i = 0; i < count; ++i) {
    const Vec3d d = random.direction();
    ASSERT_NEAR(d.x * d.x + d.y * d.y + d.z * d.z, 1, 1e-15);
    sum = sum + d;
    squares = squares + Vec3d{d.x * d.x, d.y * d.y, d.z * d.z};
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis] / count, 0, 0.04);
    EXPECT_NEAR(squares[axis] / count, 1.0 / 3, 0.02);
  }
}

}  // namespace supple::random_test
