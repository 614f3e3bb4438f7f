#include "geometry/numbers/polynomial.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <optional>

#include "geometry/numbers/root_refinement.hpp"
#include "geometry/numbers/wide_integer.hpp"

namespace supple {

namespace {

using Integer = Polynomial::Integer;
using Coefficients = std::vector<Integer>;

/// q(x + 1).
void shift_by_one(Coefficients& c) {
  for (std::size_t done = 1; done < c.size(); ++done) {
    for (std::size_t i = c.size() - 1; i >= done; --i) c[i - 1] += c[i];
  }
}

/// 2^(n bits) q((x + k) / 2^bits), where n is q's degree: q over one interval, mapped to [0, 1].
Polynomial on_interval(const Polynomial& q, const BinaryFraction& left) {
  Coefficients c = q.coefficients();
  const std::size_t size = c.size();
  if (left.bits == 0 || size == 0) return q;
  for (std::size_t i = 0; i + 1 < size; ++i) c[i] <<= static_cast<std::size_t>(left.bits) * (size - 1 - i);
  if (!left.numerator.is_zero()) {
    for (std::size_t done = 1; done < size; ++done) {
      for (std::size_t i = size - 1; i >= done; --i) c[i - 1] += c[i] * left.numerator;
    }
  }
  return Polynomial(std::move(c));
}

/// The remainder of c^(deg p - deg q + 1) p divided by q, where c is q's leading coefficient and deg p ≥ deg
/// q ≥ 0.
Polynomial pseudo_remainder(const Polynomial& p, const Polynomial& q) {
  Coefficients rest = p.coefficients();
  const Coefficients& divisor = q.coefficients();
  while (rest.size() >= divisor.size()) {
    const Integer factor = rest.back();
    const std::size_t shift = rest.size() - divisor.size();
    rest.pop_back();
    for (Integer& c : rest) c *= divisor.back();
    for (std::size_t i = 0; i + 1 < divisor.size(); ++i) rest[shift + i] -= factor * divisor[i];
  }
  return Polynomial(std::move(rest));
}

/// p / q, which is an integer. Multiplies by the inverse of q modulo a power of two, which Newton's method
/// finds (Jebelean, An algorithm for exact division, 1993). Boost divides in quadratic time.
Integer exact_quotient(const Integer& p, const Integer& q) {
  if (p.is_zero()) return 0;
  const unsigned zeros = lsb(Integer(abs(q)));
  const Integer dividend = abs(p) >> zeros, divisor = abs(q) >> zeros;
  const auto modulo = [](const Integer& value, int bits) {
    return Integer(value & ((Integer(1) << bits) - 1));
  };
  const int bits = bit_length(dividend) - bit_length(divisor) + 1;
  Integer inverse = 1;
  for (int known = 1; known < bits;) {
    known = std::min(2 * known, bits);
    const Integer one = modulo(modulo(divisor, known) * inverse, known);
    inverse = modulo(inverse * ((Integer(1) << known) + 2 - one), known);
  }
  const Integer quotient = modulo(modulo(dividend, bits) * inverse, bits);
  return p.sign() == q.sign() ? quotient : Integer(-quotient);
}

/// p / divisor, where the quotient has integer coefficients.
Polynomial exact_quotient(const Polynomial& p, const Integer& divisor) {
  Coefficients c = p.coefficients();
  for (Integer& value : c) value = exact_quotient(value, divisor);
  return Polynomial(std::move(c));
}

/// True when p and q have no common divisor modulo a prime, and therefore none at all. This test nearly
/// always avoids the slow Euclidean algorithm with unbounded integers.
bool coprime_modulo_prime(const Polynomial& p, const Polynomial& q) {
  static constexpr std::uint64_t prime = (std::uint64_t{1} << 61) - 1;
  const auto times = [](std::uint64_t a, std::uint64_t b) {
    const Int128 product = Int128{a} * b;
    return static_cast<std::uint64_t>(product % prime);
  };
  const auto residues = [](const Polynomial& polynomial) {
    std::vector<std::uint64_t> result;
    for (const Integer& c : polynomial.coefficients()) {
      const auto rest = static_cast<std::uint64_t>(abs(c) % prime);
      result.push_back(c.sign() < 0 && rest != 0 ? prime - rest : rest);
    }
    return result;
  };
  std::vector<std::uint64_t> a = residues(p), b = residues(q);
  // All divisors of p keep their degrees only if its leading coefficient is not 0 modulo the prime.
  if (a.empty() || a.back() == 0) return false;
  while (true) {
    while (!b.empty() && b.back() == 0) b.pop_back();
    if (b.size() < 2) return b.size() == 1;
    if (a.size() < b.size()) std::swap(a, b);
    const std::uint64_t factor = prime - a.back();
    const std::size_t shift = a.size() - b.size();
    for (std::uint64_t& value : a) value = times(value, b.back());
    for (std::size_t i = 0; i < b.size(); ++i) a[shift + i] = (a[shift + i] + times(factor, b[i])) % prime;
    std::swap(a, b);
  }
}

/// p / q, where the quotient has integer coefficients.
Polynomial exact_quotient(const Polynomial& p, const Polynomial& q) {
  Coefficients rest = p.coefficients();
  const Coefficients& divisor = q.coefficients();
  assert(rest.size() >= divisor.size());
  Coefficients quotient(rest.size() - divisor.size() + 1);
  for (std::size_t at = quotient.size(); at-- > 0;) {
    quotient[at] = exact_quotient(rest[at + divisor.size() - 1], divisor.back());
    for (std::size_t i = 0; i < divisor.size(); ++i) rest[at + i] -= quotient[at] * divisor[i];
  }
  return Polynomial(std::move(quotient));
}

/// 2^(n bits) p(x), where n is the degree of p.
Integer value_at(const Polynomial& p, const BinaryFraction& x) {
  const Coefficients& c = p.coefficients();
  if (c.empty()) return 0;
  Integer value = c.back();
  for (std::size_t i = c.size() - 1; i-- > 0;) {
    value *= x.numerator;
    value += c[i] << static_cast<std::size_t>(x.bits) * (c.size() - 1 - i);
  }
  return value;
}

/// The number of one of 2^bits parts of (0, 1) that may have all `variations` of the polynomial: where a
/// Newton step from 0 leads if that many roots are close together. Nothing for the first part, and when the
/// step leads out of the interval.
std::optional<Integer> part_by_newton(const Polynomial& local, int variations, int bits) {
  const Coefficients& c = local.coefficients();
  if (c[1].is_zero() || c[0].sign() == c[1].sign()) return {};
  Integer part = (abs(c[0]) * variations << bits) / abs(c[1]);
  if (part.is_zero() || bit_length(part) > bits) return {};
  return part;
}

/// Roots of p in the open interval from `left` to left + 2^-left.bits; `local` is p there, moved to [0, 1].
void isolate(const Polynomial& p, Polynomial local, BinaryFraction left, std::vector<UnitRoot>& roots) {
  const int variations = sign_variations(local).count;
  if (variations == 0) return;
  if (variations == 1) {
    roots.emplace_back(p, std::move(left));
    return;
  }
  // When one part of the interval has all variations, the rest has no roots. The parts become smaller
  // exponentially, which is fast when the roots are close together, or close to an end.
  const auto go_to_part = [&](int bits) {
    const auto go = [&](const Integer& part) {
      Polynomial smaller = on_interval(local, {part, bits});
      if (sign_variations(smaller).count != variations) return false;
      local = std::move(smaller);
      left = {(left.numerator << bits) + part, left.bits + bits};
      return true;
    };
    if (go(0) || go((Integer(1) << bits) - 1)) return true;
    const std::optional<Integer> part = part_by_newton(local, variations, bits);
    return part && go(*part);
  };
  for (int bits = 1; bits > 0;) bits = go_to_part(bits) ? 2 * bits : bits / 2;
  const Polynomial half = on_interval(local, {0, 1});
  const BinaryFraction middle{2 * left.numerator + 1, left.bits + 1};
  isolate(p, half, {2 * left.numerator, left.bits + 1}, roots);
  Coefficients right = half.coefficients();
  shift_by_one(right);
  if (right[0].is_zero()) roots.emplace_back(middle);
  isolate(p, Polynomial(std::move(right)), middle, roots);
}

}  // namespace

Polynomial::Polynomial(std::vector<Integer> coefficients) : coefficients_(std::move(coefficients)) {
  while (!coefficients_.empty() && coefficients_.back().is_zero()) coefficients_.pop_back();
}

Polynomial operator+(const Polynomial& p, const Polynomial& q) {
  const bool p_longer = p.degree() >= q.degree();
  Coefficients sum = p_longer ? p.coefficients_ : q.coefficients_;
  const Coefficients& other = p_longer ? q.coefficients_ : p.coefficients_;
  for (std::size_t i = 0; i < other.size(); ++i) sum[i] += other[i];
  return Polynomial(std::move(sum));
}

Polynomial operator-(const Polynomial& p, const Polynomial& q) {
  Coefficients difference = p.coefficients_;
  if (difference.size() < q.coefficients_.size()) difference.resize(q.coefficients_.size());
  for (std::size_t i = 0; i < q.coefficients_.size(); ++i) difference[i] -= q.coefficients_[i];
  return Polynomial(std::move(difference));
}

Polynomial operator*(const Polynomial& p, const Polynomial& q) {
  if (p.is_zero() || q.is_zero()) return {};
  Coefficients product(p.coefficients_.size() + q.coefficients_.size() - 1);
  for (std::size_t i = 0; i < p.coefficients_.size(); ++i) {
    for (std::size_t j = 0; j < q.coefficients_.size(); ++j) {
      product[i + j] += p.coefficients_[i] * q.coefficients_[j];
    }
  }
  return Polynomial(std::move(product));
}

Polynomial operator*(const Polynomial& p, const Integer& factor) {
  Coefficients product = p.coefficients_;
  for (Integer& c : product) c *= factor;
  return Polynomial(std::move(product));
}

Polynomial derivative(const Polynomial& p) {
  Coefficients slope;
  for (std::size_t i = 1; i < p.coefficients().size(); ++i) slope.push_back(p.coefficients()[i] * i);
  return Polynomial(std::move(slope));
}

Polynomial gcd(const Polynomial& p, const Polynomial& q) {
  if (coprime_modulo_prime(p, q)) return Polynomial({1});
  Polynomial larger = p, smaller = q;
  if (larger.degree() < smaller.degree()) std::swap(larger, smaller);
  if (smaller.is_zero()) return larger;
  const Integer leading = larger.coefficients().back();
  // Subresultants (Brown and Traub, On Euclid's algorithm and the theory of subresultants, 1971): divisors of
  // all coefficients are known, so no divisors of large integers are searched.
  Integer last = 1, power = 1;
  while (smaller.degree() > 0) {
    const auto degrees = static_cast<unsigned>(larger.degree() - smaller.degree());
    Polynomial rest = exact_quotient(pseudo_remainder(larger, smaller), last * pow(power, degrees));
    larger = std::move(smaller);
    smaller = std::move(rest);
    last = larger.coefficients().back();
    if (degrees > 0) power = exact_quotient(pow(last, degrees), pow(power, degrees - 1));
  }
  if (!smaller.is_zero()) return Polynomial({1});
  // The leading coefficient of the primitive divisor divides that of p or q.
  return exact_quotient(larger * leading, larger.coefficients().back());
}

Polynomial squarefree_part(const Polynomial& p) {
  const Polynomial slope = derivative(p);
  if (coprime_modulo_prime(p, slope)) return p;
  const Polynomial divisor = gcd(p, slope);
  return exact_quotient(p * divisor.coefficients().back(), divisor);
}

int sign_at(const Polynomial& p, const BinaryFraction& x) {
  return value_at(p, x).sign();
}

SignVariations sign_variations(const Polynomial& p) {
  // The coefficients of (1 + x)^n p(1 / (1 + x)) are the Bernstein coefficients times positive numbers.
  Coefficients bernstein(p.coefficients().rbegin(), p.coefficients().rend());
  shift_by_one(bernstein);
  SignVariations result;
  for (const Integer& value : bernstein) {
    const int sign = value.sign();
    if (sign == 0 || sign == result.sign) continue;
    result.count += result.sign != 0;
    result.sign = sign;
  }
  return result;
}

UnitRoot::UnitRoot(BinaryFraction x) : interval_{x.numerator, x.numerator, x.bits} {}

UnitRoot::UnitRoot(const Polynomial& p, BinaryFraction x)
    : polynomial_(p), interval_{x.numerator, x.numerator + 1, x.bits} {
  const Polynomial local = on_interval(p, x);
  assert(sign_variations(local).count % 2 == 1);
  const auto first =
      std::ranges::find_if(local.coefficients(), [](const Integer& c) { return !c.is_zero(); });
  sign_after_left_ = first->sign();
}

void UnitRoot::narrow() {
  refine(interval_, sign_after_left_, [&](const Integer& numerator, int bits) {
    return value_at(polynomial_, {numerator, bits});
  });
}

int UnitRoot::sign_of(const Polynomial& q) {
  constexpr int steps_before_zero_is_likely = 5;
  bool may_be_zero = true;
  for (int step = 0;; ++step) {
    if (is_exact()) return sign_at(q, left());
    const SignVariations variations = sign_variations(on_interval(q, left()));
    if (variations.count == 0) return variations.sign;
    if (may_be_zero && step >= steps_before_zero_is_likely) {
      // The common divisor has at most one root in the interval, a simple one. If it has one, q is 0 there.
      if (sign_variations(on_interval(gcd(polynomial_, q), left())).count % 2 == 1) return 0;
      may_be_zero = false;
    }
    narrow();
  }
}

std::pair<double, double> UnitRoot::neighbouring_doubles() {
  constexpr int digits = 53, finest = 1074;
  while (!is_exact() && bit_length(interval_.low) < digits && interval_.exponent < finest) narrow();
  return {round_time(interval_.low, interval_.exponent, false),
          round_time(interval_.high, interval_.exponent, true)};
}

std::vector<UnitRoot> roots_in_unit_interval(const Polynomial& p) {
  assert(!p.is_zero());
  std::vector<UnitRoot> roots;
  if (p.coefficients().front().is_zero()) roots.emplace_back(BinaryFraction{0, 0});
  const int variations = sign_variations(p).count;
  if (variations == 1) {
    roots.emplace_back(p, BinaryFraction{});
  } else if (variations > 1) {
    // Halving intervals separates only simple roots.
    const Polynomial simple = squarefree_part(p);
    isolate(simple, simple, {}, roots);
  }
  if (sign_at(p, {1, 0}) == 0) roots.emplace_back(BinaryFraction{1, 0});
  return roots;
}

}  // namespace supple
