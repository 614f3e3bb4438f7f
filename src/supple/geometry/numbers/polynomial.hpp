#pragma once

#include <utility>
#include <vector>

#include "geometry/numbers/integer_points.hpp"

namespace supple {

/// A polynomial of one variable with integer coefficients of any size: c[0] + c[1] x + c[2] x² + …
/// The last coefficient is not 0; the polynomial 0 has no coefficients.
class Polynomial {
 public:
  using Integer = UnboundedInteger;

  Polynomial() = default;
  explicit Polynomial(std::vector<Integer> coefficients);

  /// -1 for the polynomial 0.
  int degree() const { return static_cast<int>(coefficients_.size()) - 1; }
  bool is_zero() const { return coefficients_.empty(); }
  const std::vector<Integer>& coefficients() const { return coefficients_; }
  bool operator==(const Polynomial&) const = default;

  friend Polynomial operator+(const Polynomial& p, const Polynomial& q);
  friend Polynomial operator-(const Polynomial& p, const Polynomial& q);
  friend Polynomial operator*(const Polynomial& p, const Polynomial& q);
  friend Polynomial operator*(const Polynomial& p, const Integer& factor);

 private:
  std::vector<Integer> coefficients_;
};

Polynomial derivative(const Polynomial& p);

/// The greatest common divisor up to a constant factor. Its leading coefficient is that of the argument of
/// larger degree, or it is 1. gcd(0, 0) = 0.
Polynomial gcd(const Polynomial& p, const Polynomial& q);

/// A polynomial with the same roots, all of them simple. p is not 0.
Polynomial squarefree_part(const Polynomial& p);

/// numerator / 2^bits.
struct BinaryFraction {
  UnboundedInteger numerator = 0;
  int bits = 0;
};

/// The sign of p(x), where x = numerator / 2^bits.
int sign_at(const Polynomial& p, const BinaryFraction& x);

/// The changes of sign between a polynomial's Bernstein coefficients on an interval.
struct SignVariations {
  /// A bound of the number of roots in the open interval, counted with multiplicity. It exceeds that number
  /// by an even number (Descartes' rule of signs).
  int count = 0;
  /// The sign in the whole open interval when `count` is 0. The polynomial 0 has sign 0.
  int sign = 0;
};

/// For the open interval (0, 1).
SignVariations sign_variations(const Polynomial& p);

/// The only root of a polynomial in some interval: an algebraic number in [0, 1].
///
/// Keeps an open interval (k, k + 1) / 2^n that contains this root and no other, or the exact root k / 2^n.
/// Queries may narrow the interval, which does not change their results.
class UnitRoot {
 public:
  /// The root is exactly x.
  explicit UnitRoot(BinaryFraction x);
  /// The root of p in the open interval from x to x + 2^-x.bits. p has exactly one root there, a simple one.
  UnitRoot(const Polynomial& p, BinaryFraction x);

  /// The sign of q at the root.
  int sign_of(const Polynomial& q);

  /// The largest double that is at most the root and the smallest that is at least the root.
  std::pair<double, double> neighbouring_doubles();

 private:
  struct Interval {
    UnboundedInteger low, high;
    int exponent = 0;
    int gain = 1;
  };

  bool is_exact() const { return interval_.low == interval_.high; }
  BinaryFraction left() const { return {interval_.low, interval_.exponent}; }
  void narrow();

  Polynomial polynomial_;
  Interval interval_;
  int sign_after_left_ = 0;
};

/// The roots in [0, 1], ascending, each once. p is not 0. Roots are isolated by halving the interval until
/// Descartes' rule leaves none or one (Collins and Akritas, Polynomial real root isolation using Descartes'
/// rule of signs, 1976). Newton steps reach roots that are close together.
std::vector<UnitRoot> roots_in_unit_interval(const Polynomial& p);

}  // namespace supple
