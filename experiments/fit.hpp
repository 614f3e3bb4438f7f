#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace supple::experiments {

using Points = std::vector<std::pair<double, double>>;

/// y = factor · x^exponent.
struct PowerLaw {
  double exponent = 0;
  double factor = 0;
  double standard_error = 0;  ///< of the exponent; NaN for fewer than three points
  std::size_t points = 0;
};

/// Least squares on the logarithms, without points that have a coordinate ≤ 0. With fewer than two points
/// left, or all at one x, all results are NaN.
PowerLaw fit_power_law(const Points& points);

/// The exponent that the same fit gives for a formula at the same x. For example, n log n over a range of
/// sizes is close to a power of n.
double exponent_of(const std::function<double(double)>& formula, const Points& points);

/// `1.03 ± 0.02`
std::string text_of(const PowerLaw& fit);

/// A mean and its standard error. The error is NaN for fewer than two values; both are NaN for none.
struct Estimate {
  double mean, error;
};
Estimate estimate_of(std::span<const double> values);

/// The median and its standard error, from the median absolute deviation as for normal values (1.4826 MAD ·
/// √(π / 2n)): a few values that other work of the machine disturbs change both little. NaN as `estimate_of`.
Estimate median_of(std::span<const double> values);

/// The ratio Σ a / Σ b of quantities that were measured together, and its error by the jackknife (Tukey
/// 1958): how the ratio varies without one of the pairs. NaN as `estimate_of`, and when Σ b is 0.
Estimate ratio_of_sums(std::span<const double> a, std::span<const double> b);

/// The quotient of two independent means.
Estimate quotient(const Estimate& a, const Estimate& b);

/// `0.87 ± 0.03`
std::string text_of(const Estimate& estimate);

}  // namespace supple::experiments
