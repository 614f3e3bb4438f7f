#include "fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace supple::experiments {

PowerLaw fit_power_law(const Points& points) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Points logs;
  for (const auto& [x, y] : points) {
    if (x > 0 && y > 0) logs.emplace_back(std::log(x), std::log(y));
  }
  const double count = static_cast<double>(logs.size());
  double mean_x = 0, mean_y = 0;
  for (const auto& [x, y] : logs) {
    mean_x += x / count;
    mean_y += y / count;
  }
  double xx = 0, xy = 0;
  for (const auto& [x, y] : logs) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
  }
  if (logs.size() < 2 || !(xx > 0)) return {nan, nan, nan, logs.size()};
  const double slope = xy / xx;
  double residual = 0;
  for (const auto& [x, y] : logs) {
    const double error = y - mean_y - slope * (x - mean_x);
    residual += error * error;
  }
  const double standard_error = logs.size() < 3 ? nan : std::sqrt(residual / (count - 2) / xx);
  return {slope, std::exp(mean_y - slope * mean_x), standard_error, logs.size()};
}

double exponent_of(const std::function<double(double)>& formula, const Points& points) {
  Points model;
  for (const auto& point : points) {
    if (point.second > 0) model.emplace_back(point.first, formula(point.first));
  }
  return fit_power_law(model).exponent;
}

std::string text_of(const PowerLaw& fit) {
  if (std::isnan(fit.exponent)) return "–";
  if (std::isnan(fit.standard_error)) return fmt::format("{:.2f}", fit.exponent);
  return fmt::format("{:.2f} ± {:.2f}", fit.exponent, fit.standard_error);
}

Estimate estimate_of(std::span<const double> values) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const double count = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, values.size() < 2 ? nan : std::sqrt(squares / (count - 1) / count)};
}

namespace {

double middle(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace

Estimate median_of(std::span<const double> values) {
  const double median = middle({values.begin(), values.end()});
  if (values.size() < 2) return {median, std::numeric_limits<double>::quiet_NaN()};
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back(std::abs(value - median));
  return {median,
          1.4826 * middle(deviations) * std::sqrt(std::numbers::pi / 2 / static_cast<double>(values.size()))};
}

Estimate ratio_of_sums(std::span<const double> a, std::span<const double> b) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const double sum_a = std::accumulate(a.begin(), a.end(), 0.0),
               sum_b = std::accumulate(b.begin(), b.end(), 0.0);
  if (!(sum_b > 0)) return {nan, nan};
  std::vector<double> without_one;
  for (std::size_t i = 0; i < b.size(); ++i) without_one.push_back((sum_a - a[i]) / (sum_b - b[i]));
  const auto count = static_cast<double>(b.size());
  return {sum_a / sum_b, (count - 1) * estimate_of(without_one).error};
}

Estimate quotient(const Estimate& a, const Estimate& b) {
  const double ratio = a.mean / b.mean;
  return {ratio, ratio * std::hypot(a.error / a.mean, b.error / b.mean)};
}

std::string text_of(const Estimate& estimate) {
  if (std::isnan(estimate.mean)) return "–";
  if (std::isnan(estimate.error)) return fmt::format("{:.2f}", estimate.mean);
  return fmt::format("{:.2f} ± {:.2f}", estimate.mean, estimate.error);
}

}  // namespace supple::experiments
