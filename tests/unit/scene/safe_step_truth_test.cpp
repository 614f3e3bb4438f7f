// Safe steps of two elements against rational arithmetic.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "supple/scene.hpp"
#include "support/kept_distance.hpp"
#include "support/random.hpp"

namespace supple::safe_step_truth_test {

using truth::check_step;
using truth::MovingPair;
using truth::StepFault;
using truth::touch_at_start;
using truth::TwoElements;

TwoElements random_elements(RandomNumbers& random) {
  TwoElements e;
  const std::uint32_t kind = random.below(5), numbers = random.below(4);
  const std::size_t count_a = kind < 2 ? 2 : 1, count_b = kind < 2 ? 2 : kind < 4 ? 3 : 1;
  const auto place = [&](double offset) {
    Vec3d p = random.vector(1) + Vec3d{0, offset, 0};
    for (int axis = 0; numbers == 0 && axis < 3; ++axis) p[axis] = std::round(4 * p[axis]) / 4;
    return p;
  };
  const double offset = random.uniform(0, 3);
  const Vec3d way = random.vector(2);
  for (std::size_t i = 0; i < count_a; ++i) {
    e.start_a.push_back(place(offset));
    e.end_a.push_back(numbers == 1 ? e.start_a[i] + way : place(offset - 2));
  }
  for (std::size_t i = 0; i < count_b; ++i) {
    e.start_b.push_back(place(0));
    e.end_b.push_back(numbers <= 1 ? e.start_b[i] : place(0));
  }
  return e;
}

TEST(SafeStepTruth, OfRandomElementsIsNeverTooLongAndHardlyTooShort) {
  RandomNumbers random(32);
  int limited = 0;
  for (int i = 0; i < 300; ++i) {
    const TwoElements elements = random_elements(random);
    const std::vector<MovingPair> pairs = elements.pairs();
    if (touch_at_start(pairs)) continue;
    const double keep = std::array{0.0, 0.2, 0.5, 0.9, 0.99, random.uniform(0, 0.99)}[random.below(6)];
    const double separation = std::array{0.0, 0.25, 1.0, random.uniform(0, 2)}[random.below(4)];
    const SafeStep found = elements.scene(separation).collision_free_step({.keep = keep});
    ASSERT_EQ(check_step(pairs, separation, keep, found.step, i % 16 == 0), StepFault::none)
        << i << ": step " << found.step << ", keep " << keep << ", separation " << separation;
    ASSERT_EQ(found.step < 1, found.limit.has_value());
    limited += found.step < 1 ? 1 : 0;
  }
  EXPECT_GT(limited, 50);
}

/// A point that falls by 1 towards a large triangle at rest.
TwoElements falling_point(double height, double fall = 1) {
  const std::vector<Vec3d> floor{{-4, 0, -4}, {4, 0, -4}, {0, 0, 4}};
  return {{{0.25, height, 0}}, {{0.25, height - fall, 0}}, floor, floor};
}

/// The exact step is rational here.
TEST(SafeStepTruth, IsExactForAllShares) {
  for (const double keep : {0.0, 0.1, 0.5, 0.9, 0.99}) {
    for (const double separation : {0.0, 0x1p-20, 0.5, 1.0}) {
      for (const double beyond : {1.0, 0x1p-2, 0x1p-18, 0x1p-30, 0x1p-51}) {
        const double step =
            falling_point(separation + beyond).scene(separation).collision_free_step({.keep = keep}).step;
        const truth::Rational exact = (1 - truth::Rational(keep)) * truth::Rational(beyond);
        EXPECT_LE(truth::Rational(step), exact) << keep << " " << separation << " " << beyond;
        EXPECT_GE(truth::Rational(step), exact * (1 - truth::Rational(0x1p-18)))
            << keep << " " << separation << " " << beyond;
      }
    }
  }
}

/// Within the separation, and exactly at it, a pair keeps its share of the whole distance.
TEST(SafeStepTruth, IsExactWithinTheSeparation) {
  for (const double keep : {0.25, 0.5, 0.9}) {
    for (const double height : {1.0, 0.75, 0x1p-30}) {
      const double step = falling_point(height, 2).scene(1).collision_free_step({.keep = keep}).step;
      const truth::Rational exact = (1 - truth::Rational(keep)) * truth::Rational(height) / 2;
      EXPECT_LE(truth::Rational(step), exact) << keep << " " << height;
      EXPECT_GE(truth::Rational(step), exact * (1 - truth::Rational(0x1p-18))) << keep << " " << height;
    }
  }
}

/// The distance is a square root, and the approach is far below its rounding.
TEST(SafeStepTruth, IsExactWhereTheDistanceIsNoRationalNumber) {
  for (const double keep : {0.3, 0.9, 0.99}) {
    for (const double way : {0x1p-10, 0x1p-40, 0x1p-60}) {
      // The distance of the points is √2, and just above the separation.
      const double separation = 0x1.6a09e667f3bccp+0;
      const TwoElements elements{{{1, 1, 0}}, {{1 - way, 1, 0}}, {{0, 0, 0}}, {{0, 0, 0}}};
      const SafeStep found = elements.scene(separation).collision_free_step({.keep = keep});
      EXPECT_EQ(check_step(elements.pairs(), separation, keep, found.step), StepFault::none)
          << keep << " " << way << " " << found.step;
    }
  }
}

TEST(SafeStepTruth, IsExactForCoordinatesOfAnySize) {
  for (const double size : {0x1p1023, 1.7e308, 0x1p600, 0x1p-600, 0x1p-1040}) {
    for (const bool is_turned : {false, true}) {
      TwoElements elements{{{0, size, 0}}, {{0, -size, 0}}, {{0, -size, 0}}, {{0, size, 0}}};
      if (is_turned) {
        // Two edges, crosswise.
        elements = {{{-size, size, 0}, {size, size, 0}},
                    {{-size, -size, 0}, {size, -size, 0}},
                    {{0, -size, -size}, {0, -size, size}},
                    {{0, size, -size}, {0, size, size}}};
      }
      for (const double keep : {0.0, 0.5}) {
        const double step = elements.scene(0).collision_free_step({.keep = keep}).step;
        const double exact = (1 - keep) / 2;
        EXPECT_LE(step, exact) << size << " " << keep;
        EXPECT_GE(step, exact * (1 - 0x1p-18)) << size << " " << keep;
      }
    }
  }
}

}  // namespace supple::safe_step_truth_test
