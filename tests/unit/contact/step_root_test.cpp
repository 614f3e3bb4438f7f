// Common roots of quadratic polynomials, which decide whether elements touch at a time that no number of bits
// writes down, against the formula for roots of small integers.

#include "contact/impact/step_root.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "support/random.hpp"

namespace supple::step_root_test {

using Coefficients = std::array<int, 3>;  // of (1 - t)², t (1 - t) and t²

struct Interval {
  int low, high, exponent;
};
constexpr std::array<Interval, 5> intervals{{{0, 1, 0}, {1, 2, 2}, {2, 3, 2}, {3, 5, 3}, {0, 1, 3}}};

/// c + b t + a t².
struct Powers {
  int a, b, c;
};

Powers powers_of(const Coefficients& q) {
  return {q[0] - q[1] + q[2], q[1] - 2 * q[0], q[0]};
}

std::optional<int> root_of_square(int n) {
  const int root = static_cast<int>(std::lround(std::sqrt(static_cast<double>(n))));
  return root * root == n ? std::optional(root) : std::nullopt;
}

bool vanishes_at(const Coefficients& q, int numerator, int denominator) {
  const auto [a, b, c] = powers_of(q);
  return a * numerator * numerator + b * numerator * denominator + c * denominator * denominator == 0;
}

bool contains(const Interval& interval, int numerator, int denominator) {
  const int sign = denominator < 0 ? -1 : 1, scale = 1 << interval.exponent;
  return sign * numerator * scale > interval.low * sign * denominator &&
         sign * numerator * scale < interval.high * sign * denominator;
}

bool share_root_in(const std::vector<Coefficients>& polynomials, const Interval& interval) {
  const auto is_zero = [](const Coefficients& q) { return q == Coefficients{}; };
  const auto first = std::ranges::find_if_not(polynomials, is_zero);
  if (first == polynomials.end()) return true;
  const auto all_vanish_at = [&](int numerator, int denominator) {
    return contains(interval, numerator, denominator) &&
           std::ranges::all_of(polynomials,
                               [&](const Coefficients& q) { return vanishes_at(q, numerator, denominator); });
  };
  const auto [a, b, c] = powers_of(*first);
  if (a == 0) return b != 0 && all_vanish_at(-c, b);
  const int discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return false;
  if (const auto square_root = root_of_square(discriminant))
    return all_vanish_at(-b + *square_root, 2 * a) || all_vanish_at(-b - *square_root, 2 * a);
  // An irrational root belongs to no other polynomial than multiples of this one. It equals no end.
  for (const Coefficients& q : polynomials) {
    const auto& p = *first;
    if (p[0] * q[1] != p[1] * q[0] || p[0] * q[2] != p[2] * q[0] || p[1] * q[2] != p[2] * q[1]) return false;
  }
  const double scale = 1 << interval.exponent;
  for (const double side : {-1.0, 1.0}) {
    const double root = (-b + side * std::sqrt(static_cast<double>(discriminant))) / (2 * a);
    if (root > interval.low / scale && root < interval.high / scale) return true;
  }
  return false;
}

template <class Int>
Int integer(int value) {
  const Int size(static_cast<std::uint64_t>(std::abs(value)));
  return value < 0 ? Int(-size) : size;
}

template <class Numbers>
Quadratic<typename Numbers::Area> wide(const Coefficients& q) {
  using Area = typename Numbers::Area;
  return {integer<Area>(q[0]), integer<Area>(q[1]), integer<Area>(q[2])};
}

template <class Numbers>
TimeInterval<Numbers> wide(const Interval& interval) {
  using Time = typename Numbers::Time;
  TimeInterval<Numbers> times;
  times.low = integer<Time>(interval.low);
  times.high = integer<Time>(interval.high);
  times.exponent = interval.exponent;
  return times;
}

template <class Numbers>
bool found_in(const std::vector<Coefficients>& polynomials, const Interval& interval) {
  CommonRoots<Numbers> roots;
  for (const Coefficients& q : polynomials) roots.add(wide<Numbers>(q));
  return roots.any_in(wide<Numbers>(interval));
}

int sign_in_the_middle(const Coefficients& q, const Interval& interval) {
  const auto [a, b, c] = powers_of(q);
  const int middle = interval.low + interval.high, scale = 2 << interval.exponent;
  const int value = a * middle * middle + b * middle * scale + c * scale * scale;
  return (value > 0) - (value < 0);
}

template <class Numbers>
class CommonRootsOf : public testing::Test {};
using AllNumbers = testing::Types<FixedNumbers<1>, UnboundedNumbers>;
TYPED_TEST_SUITE(CommonRootsOf, AllNumbers);

Coefficients coefficients_of(int number) {
  return {number % 5 - 2, number / 5 % 5 - 2, number / 25 - 2};
}

TYPED_TEST(CommonRootsOf, TwoSmallPolynomials) {
  int shared = 0;
  for (int i = 0; i < 125; ++i) {
    for (int j = 0; j < 125; ++j) {
      const std::vector<Coefficients> both{coefficients_of(i), coefficients_of(j)};
      for (const Interval& interval : intervals) {
        const bool expected = share_root_in(both, interval);
        shared += expected ? 1 : 0;
        ASSERT_EQ(found_in<TypeParam>(both, interval), expected) << i << " " << j << " " << interval.low;
      }
    }
  }
  EXPECT_GT(shared, 1000);
}

TYPED_TEST(CommonRootsOf, MultiplesWithTwoRootsOrIrrationalOnes) {
  RandomNumbers random(5);
  int shared = 0;
  for (int i = 0; i < 20000; ++i) {
    Coefficients q;
    for (int& coefficient : q) coefficient = random.between(-9, 9);
    const auto times = [&](int factor) { return Coefficients{factor * q[0], factor * q[1], factor * q[2]}; };
    const std::vector<Coefficients> multiples{times(-2), times(random.between(-3, 3)), times(5)};
    const Interval& interval = intervals[static_cast<std::size_t>(i) % intervals.size()];
    const bool expected = share_root_in(multiples, interval);
    shared += expected ? 1 : 0;
    ASSERT_EQ(found_in<TypeParam>(multiples, interval), expected) << q[0] << " " << q[1] << " " << q[2];
  }
  EXPECT_GT(shared, 1000);
}

TYPED_TEST(CommonRootsOf, ASignOverAnIntervalIsThatOfEveryPoint) {
  int proven = 0;
  for (int i = 0; i < 125; ++i) {
    const Coefficients q = coefficients_of(i);
    for (const Interval& interval : intervals) {
      const int sign = sign_over(wide<TypeParam>(interval), wide<TypeParam>(q));
      if (sign == 0) continue;
      ++proven;
      ASSERT_FALSE(share_root_in({q}, interval)) << i;
      ASSERT_EQ(sign, sign_in_the_middle(q, interval)) << i;
    }
  }
  EXPECT_GT(proven, 400);
}

}  // namespace supple::step_root_test
