#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <utility>
#include <vector>

// Exact integers, and real roots by Sturm's theorem. Only verification uses this header, never the detection.

namespace supple::sturm {

using Integer =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

/// The exponent of the lowest bit of `value` that is set; the largest int for 0.
int lowest_bit(double value);
/// value / 2^lowest, for lowest ≤ lowest_bit(value).
Integer to_integer(double value, int lowest);

/// c[0] + c[1] t + c[2] t² + … The last coefficient is not 0; the polynomial 0 has no coefficients.
struct Polynomial : std::vector<Integer> {
  using std::vector<Integer>::vector;
};

Polynomial operator+(const Polynomial& p, const Polynomial& q);
Polynomial operator-(const Polynomial& p, const Polynomial& q);
Polynomial operator*(const Polynomial& p, const Polynomial& q);

/// numerator / 2^bits, at least 0.
struct Time {
  Integer numerator = 0;
  unsigned bits = 0;

  explicit Time(double value);
  Time(Integer n, unsigned b) : numerator(std::move(n)), bits(b) {}
  bool operator<(const Time& other) const { return (numerator << other.bits) < (other.numerator << bits); }
};

int sign_at(const Polynomial& p, const Time& time);

/// A real root in (0, 1]: the only root of a square-free polynomial in an open interval, or an exact time.
class Root {
 public:
  /// `p` is square-free and has exactly one root with low < t <= high.
  Root(const Polynomial& p, Time low, Time high);

  /// The largest double that is at most the root, and the smallest that is at least the root. Narrows the
  /// interval to at most these doubles.
  std::pair<double, double> neighbouring_doubles();

  /// The sign of q at the root.
  int sign_of(const Polynomial& q) const;

 private:
  void split(const Time& middle);

  Polynomial polynomial_;
  Time low_, high_;
  int sign_at_high_;  ///< of the polynomial; 0 when the root is exactly `high_`
};

/// The distinct roots of p with 0 < t <= 1, in ascending order. p is not 0.
std::vector<Root> roots_in_step(Polynomial p);

}  // namespace supple::sturm
