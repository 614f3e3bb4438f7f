#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "supple/broad_phase.hpp"
#include "supple/error.hpp"
#include "unit/broad_phase/volume_scenes.hpp"
#include "verify/algebra/distance_algebra.hpp"

namespace supple::enclosing_box_test {

using test::infinity;
using test::Random;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr float greatest = std::numeric_limits<float>::max();

/// Whether low <= value - radius and low is at most three floats below, or 2^-125 near 0, exactly.
void expect_tight(float low, double value, double radius) {
  const Rational exact = Rational(value) - Rational(radius);
  if (low == -infinity) {
    EXPECT_LT(exact, Rational(-greatest)) << value << " - " << radius;
    return;
  }
  EXPECT_LE(Rational(low), exact) << value << " - " << radius;
  float above = low;
  for (int i = 0; i < 4; ++i) above = std::nextafter(above, infinity);
  above = std::max(above, low + 0x1p-124f);
  if (above < infinity) {
    EXPECT_GT(Rational(above), exact) << value << " - " << radius;
  }
}

/// Numbers of all sizes, and neighbours of floats.
double any_number(Random& random) {
  const double number = random.uniform(-1, 1) * std::ldexp(1.0, static_cast<int>(random.below(300)) - 160);
  switch (random.below(4)) {
    case 0:
      return std::fabs(number) <= greatest ? static_cast<float>(number) : number;
    case 1:
      return std::nextafter(static_cast<double>(static_cast<float>(std::clamp(number, -1e38, 1e38))), 1e300);
    case 2:
      return std::nextafter(static_cast<double>(static_cast<float>(std::clamp(number, -1e38, 1e38))), -1e300);
    default:
      return number + number * 0x1p-30 * random.uniform(0, 1);
  }
}

TEST(EnclosingBox, ContainsTheExactBoxAndIsTight) {
  Random random(3);
  for (int i = 0; i < 20'000; ++i) {
    Vec3d lowest, highest;
    for (int axis = 0; axis < 3; ++axis) {
      lowest[axis] = any_number(random);
      highest[axis] = random.below(8) == 0 ? lowest[axis] : any_number(random);
      if (highest[axis] < lowest[axis]) std::swap(lowest[axis], highest[axis]);
    }
    const double radius = random.below(3) == 0 ? 0 : std::fabs(any_number(random));
    const Aabb box = enclosing_box(lowest, highest, radius);
    for (int axis = 0; axis < 3; ++axis) {
      expect_tight(box.min[axis], lowest[axis], radius);
      expect_tight(-box.max[axis], -highest[axis], radius);
    }
  }
}

TEST(EnclosingBox, KeepsFloats) {
  const Aabb box = enclosing_box({-1.5, 0.1f, 0}, {0x1p-149, greatest, 0x1p-126});
  EXPECT_EQ(box, (Aabb{{-1.5f, 0.1f, 0}, {0x1p-149f, greatest, 0x1p-126f}}));
  EXPECT_EQ(enclosing_box({1, 2, 3}, {4, 5, 6}, 0.5), (Aabb{{0.5f, 1.5f, 2.5f}, {4.5f, 5.5f, 6.5f}}));
}

TEST(EnclosingBox, RoundsADifferenceThatDoublesCannotRepresentOutward) {
  // 1 - 2^-60 rounds to 1, which is a float.
  const Aabb box = enclosing_box({1, 1, 1}, {1, 1, 1}, 0x1p-60);
  EXPECT_LT(box.min.x, 1);
  EXPECT_GT(box.max.x, 1);
}

TEST(EnclosingBox, OfTinyAndHugeNumbers) {
  const Aabb tiny = enclosing_box({5e-324, -5e-324, 0}, {5e-324, -5e-324, 0});
  EXPECT_EQ(tiny.min.x, 0);
  EXPECT_GT(tiny.max.x, 0);
  EXPECT_LT(tiny.min.y, 0);
  EXPECT_EQ(tiny.max.y, 0);
  EXPECT_EQ(tiny.min.z, 0);
  EXPECT_LT(enclosing_box({0, 0, 0}, {0, 0, 0}, 5e-324).min.x, 0);
  const Aabb huge = enclosing_box({-1e300, 1e39, 0}, {-1e299, 1e300, 1e308}, 1e308);
  EXPECT_EQ(huge.min, (Vec3f{-infinity, -infinity, -infinity}));
  EXPECT_EQ(huge.max, (Vec3f{infinity, infinity, infinity}));
  const Aabb far = enclosing_box({1e300, -1e300, 0}, {1e300, -1e300, 0});
  EXPECT_EQ(far, (Aabb{{greatest, -infinity, 0}, {infinity, -greatest, 0}}));
}

TEST(EnclosingBox, TakesInfinities) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Aabb half = enclosing_box({0, -inf, inf}, {inf, 1, inf}, 1);
  EXPECT_EQ(half, (Aabb{{-1, -infinity, greatest}, {infinity, 2, infinity}}));
  const Aabb all = enclosing_box({0, -inf, inf}, {inf, 1, inf}, inf);
  EXPECT_EQ(all, (Aabb{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}));
}

TEST(EnclosingBox, IsEmptyWithANanOrWithoutPoints) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d lowest{1, 1, 1}, highest{2, 2, 2};
    lowest[axis] = nan;
    EXPECT_EQ(enclosing_box(lowest, highest, 1), Aabb{});
    EXPECT_EQ(enclosing_box(highest, lowest, 1), Aabb{});
    for (const std::size_t place : {0u, 1u, 2u}) {
      std::array<Vec3d, 3> points{Vec3d{1, 2, 3}, Vec3d{4, 5, 6}, Vec3d{-1, 0, 9}};
      points[place][axis] = nan;
      EXPECT_EQ(enclosing_box(points, 1), Aabb{});
    }
    lowest[axis] = 3;
    EXPECT_EQ(enclosing_box(lowest, highest, 100), Aabb{});
  }
  EXPECT_EQ(enclosing_box(std::span<const Vec3d>{}, 1), Aabb{});
}

TEST(EnclosingBox, OfPointsIsThatOfTheirExtremes) {
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    std::vector<Vec3d> points(1 + random.below(6));
    Vec3d lowest{1e300, 1e300, 1e300}, highest = -lowest;
    for (Vec3d& point : points) {
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = any_number(random);
        lowest[axis] = std::min(lowest[axis], point[axis]);
        highest[axis] = std::max(highest[axis], point[axis]);
      }
    }
    const double radius = std::fabs(any_number(random));
    EXPECT_EQ(enclosing_box(points, radius), enclosing_box(lowest, highest, radius));
  }
}

TEST(EnclosingBox, RefusesARadiusBelowZero) {
  EXPECT_THROW(enclosing_box({0, 0, 0}, {1, 1, 1}, -1e-300), Error);
  EXPECT_THROW(enclosing_box({0, 0, 0}, {1, 1, 1}, nan), Error);
  EXPECT_NO_THROW(enclosing_box({0, 0, 0}, {1, 1, 1}, -0.0));
}

}  // namespace supple::enclosing_box_test
