#include "verify/algebra/sturm.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "support/random.hpp"

namespace supple::sturm::sturm_test {

using Rational = boost::multiprecision::cpp_rational;

/// denominator t - numerator.
Polynomial with_root(const Integer& numerator, const Integer& denominator) {
  return {-numerator, denominator};
}

TEST(Sturm, FindsRationalRootsOfAnyMultiplicity) {
  RandomNumbers random(1);
  for (int round = 0; round < 300; ++round) {
    std::set<Rational> expected;
    Polynomial p{Integer(random.below(2) == 0 ? 3 : -7)};
    for (std::uint32_t factor = random.below(4) + 1; factor > 0; --factor) {
      const Integer denominator = 1 + random.below(20), numerator = Integer(random.below(40)) - 10;
      for (std::uint32_t power = random.below(3) + 1; power > 0; --power)
        p = p * with_root(numerator, denominator);
      const Rational root(numerator, denominator);
      if (root > 0 && root <= 1) expected.insert(root);
    }
    std::vector<Root> roots = roots_in_step(p);
    ASSERT_EQ(roots.size(), expected.size()) << round;
    auto root = roots.begin();
    for (const Rational& t : expected) {
      const auto [low, high] = root->neighbouring_doubles();
      EXPECT_LE(Rational(low), t);
      EXPECT_GE(Rational(high), t);
      EXPECT_EQ(high, Rational(low) == t ? low : std::nextafter(low, 2.0));
      EXPECT_EQ(root->sign_of(p), 0);
      // The signs next to the root reveal a wrong multiplicity or a wrong interval.
      const Integer numerator = boost::multiprecision::numerator(t), scale = Integer(1) << 200;
      const Integer denominator = boost::multiprecision::denominator(t);
      EXPECT_EQ(root->sign_of(with_root(numerator * scale - 1, denominator * scale)), 1);
      EXPECT_EQ(root->sign_of(with_root(numerator * scale + 1, denominator * scale)), -1);
      ++root;
    }
  }
}

TEST(Sturm, TellsIrrationalRootsFromTheirNeighbours) {
  // The roots satisfy 2 t² = 1 and 2 t² = 1 ± 2^-300.
  const Integer scale = Integer(1) << 300;
  const Polynomial p{-1, 0, 2}, above{-scale - 1, 0, 2 * scale}, below{-scale + 1, 0, 2 * scale};
  std::vector<Root> roots = roots_in_step(p * above * below);
  ASSERT_EQ(roots.size(), 3u);
  EXPECT_EQ(roots[0].sign_of(below), 0);
  EXPECT_EQ(roots[0].sign_of(p), -1);
  EXPECT_EQ(roots[1].sign_of(p), 0);
  EXPECT_EQ(roots[1].sign_of(above), -1);
  EXPECT_EQ(roots[2].sign_of(p), 1);
  EXPECT_EQ(roots[2].sign_of(above), 0);
  for (Root& root : roots) {
    const auto [low, high] = root.neighbouring_doubles();
    EXPECT_TRUE(low < std::sqrt(0.5) + 1e-15 && high > std::sqrt(0.5) - 1e-15);
    EXPECT_EQ(high, std::nextafter(low, 1.0));
  }
}

TEST(Sturm, KnowsRootsAtTheEndsAndNearThem) {
  EXPECT_TRUE(roots_in_step({5}).empty());
  EXPECT_TRUE(roots_in_step({0, 1}).empty()) << "0 is not in the interval";
  EXPECT_TRUE(roots_in_step({1, 0, 1}).empty());
  std::vector<Root> at_end = roots_in_step({-1, 1});
  ASSERT_EQ(at_end.size(), 1u);
  EXPECT_EQ(at_end[0].neighbouring_doubles(), (std::pair<double, double>(1, 1)));
  // t = 2^-2000 is below all positive doubles.
  std::vector<Root> tiny = roots_in_step(with_root(1, Integer(1) << 2000) * with_root(1, 2));
  ASSERT_EQ(tiny.size(), 2u);
  EXPECT_EQ(tiny[0].neighbouring_doubles(), (std::pair<double, double>(0, 0x1p-1074)));
  EXPECT_EQ(tiny[1].neighbouring_doubles(), (std::pair<double, double>(0.5, 0.5)));
  EXPECT_EQ(tiny[0].sign_of({0, 1}), 1);
}

}  // namespace supple::sturm::sturm_test
