#pragma once

namespace supple {

/// high + low with |low| at most half a unit in the last place of high: about 106 bits. Sums and products
/// have a relative error below 2^-100 of the terms' magnitudes, unless they overflow or underflow.
///
/// Knuth, The Art of Computer Programming, volume 2; Dekker, A floating-point technique for extending the
/// available precision, 1971.
struct DoubleDouble {
  double high = 0, low = 0;

  DoubleDouble() = default;
  explicit DoubleDouble(double value) : high(value) {}
  DoubleDouble(double first, double second) : high(first), low(second) {}

  explicit operator double() const { return high + low; }
};

/// a + b without error.
inline DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}
/// The same, when |a| >= |b|.
inline DoubleDouble exact_sum_of_ordered(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}
/// a · b without error, for magnitudes between 2^-400 and 2^400.
inline DoubleDouble exact_product(double a, double b) {
  constexpr double splitter = 0x1p27 + 1;
  const double pa = splitter * a, pb = splitter * b;
  const double a_high = pa - (pa - a), b_high = pb - (pb - b);
  const double a_low = a - a_high, b_low = b - b_high, product = a * b;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

inline DoubleDouble operator-(const DoubleDouble& a) {
  return {-a.high, -a.low};
}
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = exact_sum(a.high, b.high), low = exact_sum(a.low, b.low);
  const DoubleDouble sum = exact_sum_of_ordered(high.high, high.low + low.high);
  return exact_sum_of_ordered(sum.high, sum.low + low.low);
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + -b;
}
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = exact_product(a.high, b.high);
  return exact_sum_of_ordered(product.high, product.low + (a.high * b.low + a.low * b.high));
}

}  // namespace supple
