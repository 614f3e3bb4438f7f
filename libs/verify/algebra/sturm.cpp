#include "verify/algebra/sturm.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace supple::sturm {
namespace {

void drop_leading_zeros(Polynomial& p) {
  while (!p.empty() && p.back().is_zero()) p.pop_back();
}

Polynomial derivative(const Polynomial& p) {
  Polynomial result;
  for (std::size_t i = 1; i < p.size(); ++i) result.push_back(p[i] * i);
  return result;
}

/// p divided by the greatest common divisor of its coefficients. Keeps the sign.
void reduce(Polynomial& p) {
  Integer divisor = 0;
  for (auto c = p.rbegin(); c != p.rend() && divisor != 1; ++c) divisor = gcd(divisor, *c);
  if (divisor > 1) {
    for (Integer& c : p) c /= divisor;
  }
}

/// The remainder of |c|^n p divided by q. c is the leading coefficient of q, n = max(deg p - deg q + 1, 0).
Polynomial remainder(Polynomial p, const Polynomial& q) {
  const Integer scale = abs(q.back());
  while (p.size() >= q.size()) {
    const Integer factor = q.back().sign() < 0 ? Integer(-p.back()) : p.back();
    p.pop_back();
    for (Integer& c : p) c *= scale;
    const std::size_t shift = p.size() + 1 - q.size();
    for (std::size_t i = 0; i + 1 < q.size(); ++i) p[shift + i] -= factor * q[i];
  }
  drop_leading_zeros(p);
  return p;
}

/// p / q up to a constant factor, where q divides p.
Polynomial quotient(Polynomial p, const Polynomial& q) {
  Polynomial result(p.size() - q.size() + 1);
  for (std::size_t at = result.size(); at-- > 0;) {
    result[at] = p[at + q.size() - 1];
    for (std::size_t i = 0; i < at + q.size(); ++i) p[i] *= q.back();
    for (std::size_t i = at + 1; i < result.size(); ++i) result[i] *= q.back();
    for (std::size_t i = 0; i < q.size(); ++i) p[at + i] -= result[at] * q[i];
  }
  reduce(result);
  return result;
}

/// The chain p, q, r, …: each further polynomial is a positive multiple of the negative remainder of the two
/// before it. The last one is the greatest common divisor of p and q. deg q < deg p. Coefficients are divided
/// as in subresultants, which keeps them short (Brown and Traub, On Euclid's algorithm and the theory of
/// subresultants, 1971).
std::vector<Polynomial> signed_remainders(const Polynomial& p, const Polynomial& q) {
  std::vector<Polynomial> chain = {p};
  Integer leading = 1, power = 1;
  for (Polynomial next = q; !next.empty();) {
    const auto degrees = static_cast<unsigned>(chain.back().size() - next.size());
    const Integer divisor = -(leading * pow(power, degrees));
    leading = abs(next.back());
    chain.push_back(std::move(next));
    next = remainder(chain[chain.size() - 2], chain.back());
    for (Integer& c : next) c /= divisor;
    power = pow(leading, degrees) / pow(power, degrees - 1);
  }
  return chain;
}

int variations(const std::vector<Polynomial>& chain, const Time& time) {
  int count = 0, last = 0;
  for (const Polynomial& p : chain) {
    const int sign = sign_at(p, time);
    if (sign == 0) continue;
    count += sign == -last;
    last = sign;
  }
  return count;
}

Integer value_at(const Polynomial& p, const Time& time) {
  Integer value = 0;
  for (std::size_t i = p.size(); i-- > 0;) {
    value = value * time.numerator + (p[i] << time.bits * (p.size() - 1 - i));
  }
  return value;
}

/// A time between two others, on a logarithmic scale while they differ in magnitude.
Time between(const Time& low, const Time& high) {
  const auto exponent = [](const Time& time) {
    return static_cast<int>(time.bits) - static_cast<int>(msb(time.numerator));
  };
  const int end = exponent(high), start = low.numerator.is_zero() ? 2 * end + 2 : exponent(low);
  if (start > end + 2) return {1, static_cast<unsigned>(end + (start - end) / 2)};
  const unsigned bits = std::max(low.bits, high.bits);
  return {(low.numerator << (bits - low.bits)) + (high.numerator << (bits - high.bits)), bits + 1};
}

}  // namespace

int lowest_bit(double value) {
  if (value == 0) return std::numeric_limits<int>::max();
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  return exponent - 53 + std::countr_zero(static_cast<std::uint64_t>(mantissa));
}

Integer to_integer(double value, int lowest) {
  if (value == 0) return 0;
  const int last = lowest_bit(value);
  return Integer(static_cast<std::int64_t>(std::ldexp(value, -last))) << (last - lowest);
}

Polynomial operator+(const Polynomial& p, const Polynomial& q) {
  if (p.size() < q.size()) return q + p;
  Polynomial result = p;
  for (std::size_t i = 0; i < q.size(); ++i) result[i] += q[i];
  drop_leading_zeros(result);
  return result;
}

Polynomial operator-(const Polynomial& p, const Polynomial& q) {
  return p + Polynomial{-1} * q;
}

Polynomial operator*(const Polynomial& p, const Polynomial& q) {
  if (p.empty() || q.empty()) return {};
  Polynomial result(p.size() + q.size() - 1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) result[i + j] += p[i] * q[j];
  }
  return result;
}

Time::Time(double value) {
  const int lowest = std::min(lowest_bit(value), 0);
  numerator = to_integer(value, lowest);
  bits = static_cast<unsigned>(-lowest);
}

int sign_at(const Polynomial& p, const Time& time) {
  return value_at(p, time).sign();
}

Root::Root(const Polynomial& p, Time low, Time high)
    : polynomial_(p), low_(std::move(low)), high_(std::move(high)), sign_at_high_(sign_at(p, high_)) {
  // The start may be another root, but `sign_of` needs a start that is not a root.
  while (sign_at_high_ != 0 && sign_at(polynomial_, low_) == 0) split(between(low_, high_));
}

void Root::split(const Time& middle) {
  const int sign = sign_at(polynomial_, middle);
  if (sign == -sign_at_high_) {
    low_ = middle;
  } else {
    high_ = middle;
    sign_at_high_ = sign;
  }
}

std::pair<double, double> Root::neighbouring_doubles() {
  // Positive doubles have the same order as their bits.
  auto low = std::bit_cast<std::uint64_t>(0.0), high = std::bit_cast<std::uint64_t>(1.0);
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    const Time time(std::bit_cast<double>(middle));
    if (sign_at_high_ != 0 && low_ < time && time < high_) split(time);
    const bool is_low = sign_at_high_ == 0 ? time < high_ : !(low_ < time);
    (is_low ? low : high) = middle;
  }
  const double below = std::bit_cast<double>(low), above = std::bit_cast<double>(high);
  return {sign_at_high_ == 0 && !(high_ < Time(above)) ? above : below, above};
}

int Root::sign_of(const Polynomial& q) const {
  if (sign_at_high_ == 0) return sign_at(q, high_);
  // Sums of positive terms increase with time, so their values at both ends bound q in the interval.
  Polynomial positive, negative;
  for (const Integer& c : q) {
    positive.push_back(c.sign() > 0 ? c : Integer(0));
    negative.push_back(c.sign() < 0 ? Integer(-c) : Integer(0));
  }
  const unsigned bits = std::max(low_.bits, high_.bits);
  const Time low(low_.numerator << (bits - low_.bits), bits);
  const Time high(high_.numerator << (bits - high_.bits), bits);
  if (value_at(positive, low) > value_at(negative, high)) return 1;
  if (value_at(positive, high) < value_at(negative, low)) return -1;
  // Sylvester: the sum of the signs of q at the roots of p is the change of variations of this chain.
  const auto chain = signed_remainders(polynomial_, remainder(derivative(polynomial_) * q, polynomial_));
  return variations(chain, low_) - variations(chain, high_);
}

std::vector<Root> roots_in_step(Polynomial p) {
  std::vector<Root> roots;
  reduce(p);
  std::vector<Polynomial> chain = signed_remainders(p, derivative(p));
  if (chain.back().size() > 1) {
    reduce(chain.back());
    p = quotient(std::move(p), chain.back());
    chain = signed_remainders(p, derivative(p));
  }
  struct Part {
    Time low, high;
    int variations_low, variations_high;
  };
  const Time start(0, 0), end(1, 0);
  std::vector<Part> parts = {{start, end, variations(chain, start), variations(chain, end)}};
  while (!parts.empty()) {
    const Part part = std::move(parts.back());
    parts.pop_back();
    const int count = part.variations_low - part.variations_high;
    if (count == 1) roots.emplace_back(p, part.low, part.high);
    if (count <= 1) continue;
    const Time middle = between(part.low, part.high);
    const int variations_middle = variations(chain, middle);
    parts.push_back({middle, part.high, variations_middle, part.variations_high});
    parts.push_back({part.low, middle, part.variations_low, variations_middle});
  }
  return roots;
}

}  // namespace supple::sturm
