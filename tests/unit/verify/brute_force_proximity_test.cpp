// The filter of the brute force in double precision, compared with rationals.

#include "verify/algebra/distance_algebra.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/random.hpp"

namespace supple::brute_force_proximity_test {

/// Elements whose sides are parallel up to rounding, or that are tiny: their normals are noise.
TEST(ClearlyApart, IsNeverTrueWithinReach) {
#ifdef NDEBUG
  constexpr int rounds = 4000;
#else
  constexpr int rounds = 300;
#endif
  RandomNumbers random(5);
  int apart = 0, within = 0;
  for (int round = 0; round < rounds; ++round) {
    const Vec3d origin = random.vector(1), along = random.vector(1);
    const double noise = round % 2 == 0 ? 1e-16 : 1e-3, scale = std::exp2(random.between(-3, 0) * 90);
    const auto point = [&] {
      return scale * (origin + static_cast<double>(random.between(-2, 2)) * along + random.vector(noise));
    };
    const std::array<Vec3d, 3> triangle{point(), point(), point()};
    const std::array<Vec3d, 2> edge{point(), point()}, other{point(), point()};
    const Vec3d vertex = random.below(2) == 0 ? point() : scale * random.vector(2);
    const auto expect_safe = [&](std::span<const Vec3d> a, std::span<const Vec3d> b) {
      std::array<Vec3d, 4> points;
      std::ranges::copy(b, std::ranges::copy(a, points.begin()).out);
      const Rational squared = distance_by_algebra(a, b).squared;
      const double distance = std::sqrt(squared.convert_to<double>());
      for (const double reach : {0.0, distance / 2, distance, 2 * distance}) {
        const bool are_apart = clearly_apart(points, points, a.size(), reach),
                   are_within = squared <= Rational(reach) * Rational(reach);
        EXPECT_FALSE(are_apart && are_within) << round << ": reach " << reach << ", distance " << distance;
        apart += are_apart ? 1 : 0;
        within += are_within ? 1 : 0;
      }
    };
    expect_safe({&vertex, 1}, triangle);
    expect_safe(edge, other);
  }
  EXPECT_GT(apart, rounds / 10);
  EXPECT_GT(within, rounds / 10);
}

}  // namespace supple::brute_force_proximity_test
