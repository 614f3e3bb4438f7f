#include "geometry/numbers/polynomial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

#include "support/soups.hpp"

namespace supple::polynomial_test {

using Integer = Polynomial::Integer;
using Rational = boost::multiprecision::cpp_rational;

Polynomial power(const Polynomial& p, int exponent) {
  Polynomial result({1});
  for (int i = 0; i < exponent; ++i) result = result * p;
  return result;
}

/// denominator x - numerator.
Polynomial with_root(Integer numerator, Integer denominator) {
  return Polynomial({-numerator, std::move(denominator)});
}

Polynomial random_polynomial(RandomNumbers& random, int degree, std::uint32_t size) {
  std::vector<Integer> c;
  for (int i = 0; i <= degree; ++i) c.push_back(Integer(random.below(2 * size + 1)) - size);
  return Polynomial(std::move(c));
}

/// The coefficients divided by their greatest common divisor, with a positive leading coefficient.
Polynomial primitive_part(const Polynomial& p) {
  Integer content = 0;
  for (const Integer& c : p.coefficients()) content = boost::multiprecision::gcd(content, c);
  if (!p.is_zero() && p.coefficients().back().sign() < 0) content = -content;
  std::vector<Integer> c = p.coefficients();
  for (Integer& value : c) value /= content;
  return Polynomial(std::move(c));
}

using RationalPolynomial = std::vector<Rational>;

Rational value_at(const RationalPolynomial& p, const Rational& x) {
  Rational value = 0;
  for (std::size_t i = p.size(); i-- > 0;) value = value * x + p[i];
  return value;
}

RationalPolynomial negated_remainder(RationalPolynomial p, const RationalPolynomial& q) {
  while (p.size() >= q.size()) {
    const Rational factor = p.back() / q.back();
    for (std::size_t i = 0; i < q.size(); ++i) p[p.size() - q.size() + i] -= factor * q[i];
    while (!p.empty() && p.back() == 0) p.pop_back();
  }
  for (Rational& c : p) c = -c;
  return p;
}

/// The number of roots of p in [0, 1], by Sturm's theorem.
int sturm_count(const Polynomial& p) {
  RationalPolynomial first(p.coefficients().begin(), p.coefficients().end()), second;
  for (std::size_t i = 1; i < first.size(); ++i) second.push_back(first[i] * static_cast<int>(i));
  std::vector<RationalPolynomial> sequence{first};
  while (!second.empty()) {
    sequence.push_back(second);
    second = negated_remainder(sequence[sequence.size() - 2], second);
  }
  const auto variations = [&](const Rational& x) {
    int count = 0, sign = 0;
    for (const RationalPolynomial& q : sequence) {
      const int next = value_at(q, x).sign();
      if (next != 0 && next == -sign) ++count;
      if (next != 0) sign = next;
    }
    return count;
  };
  // The theorem counts the roots in (a, b]; neither end may be a multiple root.
  const Rational below(-1, 1000000000);
  return variations(below) - variations(1);
}

TEST(Polynomial, ArithmeticDropsLeadingZeros) {
  const Polynomial p({1, 2, 3}), q({-1, 4, -3});
  EXPECT_EQ(p + q, Polynomial({0, 6}));
  EXPECT_EQ(q + p, Polynomial({0, 6}));
  EXPECT_EQ(p - p, Polynomial());
  EXPECT_EQ(Polynomial({5}) - p, Polynomial({4, -2, -3}));
  EXPECT_EQ(p * q, Polynomial({-1, 2, 2, 6, -9}));
  EXPECT_EQ(p * Integer(0), Polynomial());
  EXPECT_EQ(p * Polynomial(), Polynomial());
  EXPECT_EQ(Polynomial({0, 0}).degree(), -1);
  EXPECT_EQ(derivative(Polynomial({7, 5, 3, 2})), Polynomial({5, 6, 6}));
  EXPECT_TRUE(derivative(Polynomial({7})).is_zero());
}

TEST(Polynomial, GcdOfProducts) {
  RandomNumbers random(1);
  int common = 0;
  for (int i = 0; i < 500; ++i) {
    const Polynomial shared = random_polynomial(random, static_cast<int>(random.below(4)), 1 << 20);
    const Polynomial p = random_polynomial(random, 3, 5), q = random_polynomial(random, 2, 5);
    if (shared.is_zero() || p.is_zero() || q.is_zero()) continue;
    common += shared.degree() > 0;
    // A common factor of both arguments multiplies their gcd.
    EXPECT_EQ(primitive_part(gcd(p * shared, q * shared)), primitive_part(gcd(p, q) * shared));
  }
  EXPECT_GT(common, 300);
}

TEST(Polynomial, GcdOfSpecialCases) {
  const Polynomial p({-2, 0, 6});
  EXPECT_EQ(gcd(p, Polynomial()), p);
  EXPECT_EQ(gcd(Polynomial(), p), p);
  EXPECT_TRUE(gcd(Polynomial(), Polynomial()).is_zero());
  EXPECT_EQ(gcd(p, Polynomial({4})), Polynomial({1}));
  EXPECT_EQ(gcd(Polynomial({4}), Polynomial()).degree(), 0);
  EXPECT_EQ(primitive_part(gcd(p, p * Integer(-5))), Polynomial({-1, 0, 3}));
  // Coefficients that vanish modulo the first prime that gcd tries.
  const Integer prime = (Integer(1) << 61) - 1;
  const Polynomial q = with_root(3, prime);
  EXPECT_EQ(primitive_part(gcd(q * with_root(1, 2), q * with_root(1, 3))), q);
  EXPECT_EQ(gcd(q * prime, with_root(1, 2) * prime), Polynomial({1}));
}

TEST(Polynomial, GcdOfLargeCoefficients) {
  const Integer large = Integer(1) << 5000;
  const Polynomial shared = with_root(large / 3, large) * with_root(-large / 5, large - 1);
  const Polynomial p = shared * with_root(large / 7, large) * with_root(2, large + 1) * Integer(-9);
  const Polynomial q = shared * with_root(3, large) * Polynomial({large, 1, large / 11});
  EXPECT_EQ(primitive_part(gcd(p, q)), primitive_part(shared));
  EXPECT_EQ(primitive_part(gcd(q, p)), primitive_part(shared));
}

TEST(Polynomial, SquarefreePartKeepsEachRootOnce) {
  const Polynomial a = with_root(1, 3), b = with_root(-2, 5), c({1, 0, 1});
  const Polynomial simple = squarefree_part(power(a, 3) * power(b, 2) * power(c, 2) * Integer(6));
  EXPECT_EQ(primitive_part(simple), a * b * c);
  EXPECT_EQ(primitive_part(squarefree_part(power(a, 2) * b * Integer(-6))), a * b);
  EXPECT_EQ(primitive_part(squarefree_part(a * b * Integer(-4))), a * b);
  EXPECT_EQ(squarefree_part(Polynomial({9})).degree(), 0);
}

TEST(Polynomial, SignAtBinaryFraction) {
  const Polynomial p = with_root(3, 8) * with_root(5, 8);
  EXPECT_EQ(sign_at(p, {3, 3}), 0);
  EXPECT_EQ(sign_at(p, {1, 1}), -1);
  EXPECT_EQ(sign_at(p, {(Integer(3) << 200) - 1, 203}), 1);
  EXPECT_EQ(sign_at(p, {(Integer(3) << 200) + 1, 203}), -1);
  EXPECT_EQ(sign_at(Polynomial(), {1, 0}), 0);
}

TEST(Polynomial, SignVariationsBoundRoots) {
  EXPECT_EQ(sign_variations(Polynomial({1, 1})).count, 0);
  EXPECT_EQ(sign_variations(Polynomial({-1, -1})).sign, -1);
  EXPECT_EQ(sign_variations(with_root(1, 3)).count, 1);
  EXPECT_EQ(sign_variations(with_root(1, 3) * with_root(2, 3)).count, 2);
  // Roots at the ends of the interval do not count.
  EXPECT_EQ(sign_variations(Polynomial({0, 1, -1})).count, 0);
  EXPECT_EQ(sign_variations(Polynomial()).sign, 0);
}

TEST(UnitRoots, AreAsManyAsSturmCounts) {
  RandomNumbers random(2);
  std::size_t total = 0;
  for (int i = 0; i < 3000; ++i) {
    Polynomial p = random_polynomial(random, 1 + static_cast<int>(random.below(6)), 4);
    if (p.is_zero()) continue;
    // Sturm's theorem requires that no end is a multiple root. A test above covers the squarefree part.
    const Polynomial simple = squarefree_part(p);
    const std::vector<UnitRoot> roots = roots_in_unit_interval(p);
    total += roots.size();
    ASSERT_EQ(static_cast<int>(roots.size()), simple.degree() > 0 ? sturm_count(simple) : 0) << i;
  }
  EXPECT_GT(total, 1000u);
}

/// Expects that the root's bracket consists of the doubles next to x.
void expect_neighbours(UnitRoot& root, const Rational& x) {
  const auto [low, high] = root.neighbouring_doubles();
  EXPECT_LE(Rational(low), x);
  EXPECT_GE(Rational(high), x);
  EXPECT_EQ(high, Rational(low) == x ? low : std::nextafter(low, 2.0));
}

TEST(UnitRoots, ArisesOncePerRationalRootInOrder) {
  RandomNumbers random(3);
  for (int i = 0; i < 300; ++i) {
    std::vector<Rational> known;
    Polynomial p({static_cast<int>(random.below(9)) - 4, 1, 3});  // may have roots outside [0, 1]
    if (sign_at(p, {0, 0}) * sign_at(p, {1, 0}) <= 0) continue;
    for (std::uint32_t k = 1 + random.below(4); k > 0; --k) {
      const std::uint32_t denominator = 1 + random.below(12), numerator = random.below(denominator + 1);
      known.emplace_back(numerator, denominator);
      p = p * power(with_root(numerator, denominator), 1 + static_cast<int>(random.below(3)));
    }
    std::ranges::sort(known);
    known.erase(std::unique(known.begin(), known.end()), known.end());
    std::vector<UnitRoot> roots = roots_in_unit_interval(p);
    ASSERT_EQ(roots.size(), known.size());
    for (std::size_t k = 0; k < known.size(); ++k) {
      EXPECT_EQ(roots[k].sign_of(with_root(numerator(known[k]), denominator(known[k]))), 0);
      EXPECT_EQ(roots[k].sign_of(p), 0);
      expect_neighbours(roots[k], known[k]);
    }
  }
}

TEST(UnitRoots, CloseTogether) {
  const Integer large = Integer(1) << 200;
  const Polynomial p = with_root(large / 3, large) * with_root(large / 3 + 1, large) * with_root(1, large);
  std::vector<UnitRoot> roots = roots_in_unit_interval(p);
  ASSERT_EQ(roots.size(), 3u);
  expect_neighbours(roots[0], Rational(1, large));
  expect_neighbours(roots[1], Rational(large / 3, large));
  EXPECT_EQ(roots[1].sign_of(with_root(large / 3, large)), 0);
  EXPECT_EQ(roots[1].sign_of(with_root(large / 3 + 1, large)), -1);
  EXPECT_EQ(roots[2].sign_of(with_root(large / 3, large)), 1);
  EXPECT_EQ(roots[2].sign_of(with_root(large / 3 + 1, large)), 0);
}

/// Bisection would take 40,000 steps for each root.
TEST(UnitRoots, CloserThanAnyBisectionReaches) {
  const Integer large = Integer(1) << 40000;
  for (const int part : {2, 3}) {  // around 1/2 and 1/3
    const Integer near = large / part;
    const Polynomial p = with_root(near - 5, large) * with_root(near + 6, large) * with_root(1, large);
    std::vector<UnitRoot> roots = roots_in_unit_interval(p * p);
    ASSERT_EQ(roots.size(), 3u);
    expect_neighbours(roots[0], Rational(1, large));
    expect_neighbours(roots[1], Rational(near - 5, large));
    EXPECT_EQ(roots[1].sign_of(with_root(near - 5, large)), 0);
    EXPECT_EQ(roots[1].sign_of(with_root(near - 4, large)), -1);
    EXPECT_EQ(roots[1].sign_of(with_root(near - 6, large)), 1);
    EXPECT_EQ(roots[2].sign_of(with_root(near + 6, large) * with_root(-1, 3)), 0);
    EXPECT_EQ(roots[2].sign_of(with_root(near + 5, large)), 1);
  }
}

TEST(UnitRoots, TinyOnes) {
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  const auto neighbours = [](const Integer& numerator, unsigned bits) {
    std::vector<UnitRoot> roots = roots_in_unit_interval(with_root(numerator, Integer(1) << bits));
    EXPECT_EQ(roots.size(), 1u);
    return roots.at(0).neighbouring_doubles();
  };
  EXPECT_EQ(neighbours(1, 1074), (std::pair{smallest, smallest}));
  EXPECT_EQ(neighbours(1, 1075), (std::pair{0.0, smallest}));
  EXPECT_EQ(neighbours(1, 3000), (std::pair{0.0, smallest}));
  EXPECT_EQ(neighbours(5, 1075), (std::pair{2 * smallest, 3 * smallest}));
  EXPECT_EQ(neighbours(0, 1), (std::pair{0.0, 0.0}));
  EXPECT_EQ(neighbours(1, 0), (std::pair{1.0, 1.0}));
  EXPECT_EQ(neighbours((Integer(1) << 60) - 1, 60), (std::pair{std::nextafter(1.0, 0.0), 1.0}));
}

TEST(UnitRoots, SignOfOthersAtAnIrrationalRoot) {
  const Polynomial p({-1, 0, 2});  // the root is √½
  std::vector<UnitRoot> roots = roots_in_unit_interval(p * p * with_root(-1, 3));
  ASSERT_EQ(roots.size(), 1u);
  UnitRoot& root = roots[0];
  EXPECT_EQ(root.sign_of(p * Polynomial({3, -7, 2})), 0);
  EXPECT_EQ(root.sign_of(Polynomial()), 0);
  EXPECT_EQ(root.sign_of(Polynomial({-3})), -1);
  EXPECT_EQ(root.sign_of(Polynomial({-7, 10})), 1);
  EXPECT_EQ(root.sign_of(Polynomial({-71, 100})), -1);
  // Two rationals within 2^-300 of the root, one on each side.
  const Integer below = sqrt(Integer(1) << 601);
  EXPECT_EQ(root.sign_of(with_root(below, Integer(1) << 301)), 1);
  EXPECT_EQ(root.sign_of(with_root(below + 1, Integer(1) << 301)), -1);
  // A polynomial that has this root and another root very close to it.
  EXPECT_EQ(root.sign_of(p * with_root(below, Integer(1) << 301)), 0);
  EXPECT_EQ(root.neighbouring_doubles(), (std::pair{std::nextafter(std::sqrt(0.5), 0.0), std::sqrt(0.5)}));
}

}  // namespace supple::polynomial_test
