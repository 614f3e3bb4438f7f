#include "inputs/half_turns.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "supple/trigonometry.hpp"
#include "support/random.hpp"

namespace supple::cli::half_turns_test {

/// Turns about an axis of length 1 through a point.
std::vector<Vec3d> turned(const std::vector<Vec3d>& points, Vec3d axis, double degrees, Vec3d through = {}) {
  const double angle = degrees * std::acos(-1.0) / 180, c = std::cos(angle), s = std::sin(angle);
  std::vector<Vec3d> result;
  for (const Vec3d& point : points) {
    const Vec3d p = point - through;
    result.push_back(through + c * p + s * cross(axis, p) + ((1 - c) * dot(axis, p)) * axis);
  }
  return result;
}

std::vector<Vec3d> cloud(RandomNumbers& random, Vec3d size) {
  std::vector<Vec3d> points(40);
  for (Vec3d& p : points) {
    p = random.vector(1);
    for (int axis = 0; axis < 3; ++axis) p[axis] *= size[axis];
  }
  return points;
}

TEST(HalfTurns, FindsTurnsOfBodiesOfAnyShape) {
  RandomNumbers random(5);
  // Round, flat, long, a rod, and far away.
  for (const Vec3d size : {Vec3d{1, 1, 1}, Vec3d{1, 1, 0}, Vec3d{1, 0.01, 0.01}, Vec3d{1, 0, 0}}) {
    for (int round = 0; round < 50; ++round) {
      const std::vector<Vec3d> body = cloud(random, size);
      Vec3d axis = random.vector(1);
      if (size.y < 1) axis.x = 0;  // a long body that turns about itself hardly moves
      axis = axis / norm(axis);
      const Vec3d through = random.vector(100);
      for (const double degrees : {-180.0, -150.0, 130.0, 180.0})
        EXPECT_TRUE(turns_too_far(body, turned(body, axis, degrees, through))) << degrees;
      for (const double degrees : {0.0, 1e-6, 1.0, 45.0, 90.0, -110.0, 360.0})
        EXPECT_FALSE(turns_too_far(body, turned(body, axis, degrees, through))) << degrees;
    }
  }
}

TEST(HalfTurns, OtherMotionIsNone) {
  RandomNumbers random(6);
  for (int round = 0; round < 200; ++round) {
    const std::vector<Vec3d> body = cloud(random, {1, 1, 1});
    std::vector<Vec3d> moved = body, mirrored = body, stretched = body, noisy = body;
    const Vec3d way = random.vector(10);
    for (std::size_t v = 0; v < body.size(); ++v) {
      moved[v] += way;
      mirrored[v].x *= -1;
      stretched[v] = 5.0 * stretched[v];
      noisy[v] += random.vector(1);
    }
    for (const auto& to : {body, moved, mirrored, stretched, noisy, cloud(random, {1, 1, 1})})
      EXPECT_FALSE(turns_too_far(body, to));
  }
}

TEST(HalfTurns, NeedsFiniteVerticesThatMove) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3d> one{{1, 2, 3}}, square{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  EXPECT_FALSE(turns_too_far({}, {}));
  EXPECT_FALSE(turns_too_far(one, one));
  std::vector<Vec3d> from = square, to = turned(square, {0, 0, 1}, 180);
  from.push_back({nan, 0, 0});
  to.push_back({1e300, 0, 0});
  EXPECT_TRUE(turns_too_far(from, to)) << "vertices that are not finite do not count";
  from.push_back({1e300, 0, 0});
  to.push_back({-1e300, 0, 0});
  EXPECT_FALSE(turns_too_far(from, to)) << "squares overflow, so nothing is known";
}

}  // namespace supple::cli::half_turns_test
