#include "geometry/numbers/root_refinement.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace supple::root_refinement_test {

using Integer = UnboundedInteger;

struct Interval {
  Integer low, high;
  int exponent = 0;
  int gain = 1;
};

/// The product of (denominator x - numerator), and how often it was evaluated.
struct CountedProduct {
  struct Root {
    Integer numerator, denominator;
  };
  std::vector<Root> roots;
  int evaluations = 0;

  Integer operator()(const Integer& x, int exponent) {
    ++evaluations;
    Integer value = 1;
    for (const Root& root : roots) value *= root.denominator * x - (root.numerator << exponent);
    return value;
  }
};

/// Narrows an interval to 2^-bits. Expects that it still contains the first root.
Interval refined(CountedProduct& product, Interval interval, int sign_before, int bits) {
  for (int step = 0; interval.low != interval.high && interval.exponent < bits; ++step) {
    if (step > 10000) {
      ADD_FAILURE() << "does not end";
      break;
    }
    refine(interval, sign_before, [&](const Integer& x, int exponent) { return product(x, exponent); });
    const CountedProduct::Root& root = product.roots.front();
    const Integer scaled = root.numerator << interval.exponent;
    if (interval.low == interval.high) {
      EXPECT_EQ(interval.low * root.denominator, scaled);
    } else {
      EXPECT_LT(interval.low * root.denominator, scaled);
      EXPECT_GT(interval.high * root.denominator, scaled);
    }
  }
  return interval;
}

TEST(RootRefinement, TakesLogarithmicallyManySteps) {
  CountedProduct product{{{1, 3}, {5, 2}, {-4, 1}}};
  const Interval interval = refined(product, {0, 1}, 1, 20000);
  EXPECT_EQ(interval.high - interval.low, 1);
  EXPECT_LT(product.evaluations, 100);
}

TEST(RootRefinement, FindsARootNextToAnEndThatIsAnotherRoot) {
  const Integer near = Integer(1) << 5000;
  CountedProduct above_low{{{near + 3, 2 * near}, {1, 2}}};
  refined(above_low, {1, 2, 1}, -1, 20000);
  EXPECT_LT(above_low.evaluations, 200);
  CountedProduct below_high{{{near - 3, 2 * near}, {1, 2}}};
  refined(below_high, {0, 1, 1}, 1, 20000);
  EXPECT_LT(below_high.evaluations, 200);
}

TEST(RootRefinement, FindsARootBetweenTwoEndsThatAreRoots) {
  CountedProduct product{{{1, 3}, {0, 1}, {1, 1}}};
  refined(product, {0, 1}, 1, 5000);
  EXPECT_LT(product.evaluations, 200);
}

TEST(RootRefinement, FindsARootNextToOneOutsideOfTheInterval) {
  // 1/3, and another root 2^-3000 beyond the end of the interval.
  const Integer near = Integer(1) << 3000;
  CountedProduct product{{{near / 3, near}, {near / 3 - 2, near}}};
  refined(product, {near / 3 - 1, near / 3 + 1, 3000}, -1, 20000);
  EXPECT_LT(product.evaluations, 200);
}

TEST(RootRefinement, StopsAtExactRoots) {
  CountedProduct middle{{{1, 2}}};
  const Interval at_middle = refined(middle, {0, 1}, -1, 100);
  EXPECT_EQ(at_middle.low, at_middle.high);
  CountedProduct fine{{{5, 1 << 20}}};
  const Interval at_fine = refined(fine, {0, 1}, -1, 1000);
  EXPECT_EQ(at_fine.low, at_fine.high);
}

}  // namespace supple::root_refinement_test
