#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/fit.hpp"
#include "experiments/report.hpp"

namespace supple::experiments {

/// What was measured against the size, and the formula that the paper gives for it.
struct Growth {
  std::string quantity;  ///< `Brute force, step in motion`
  std::string unit;      ///< `tests`, or `time`
  Points points;
  std::string formula;                         ///< `n log n`; empty: no claim
  std::function<double(double)> formula_at{};  ///< up to a factor

  bool counts() const { return unit != "time"; }
};

/// An exponent above that of the formula by no more than this, or twice its standard error, is within a
/// bound.
inline constexpr double exponent_tolerance = 0.1;
/// A time above it by more than that but less than this says nothing: caches and the cost of starting bend
/// times.
inline constexpr double time_tolerance = 0.25;

/// Whether the measured exponents are within the formulas', a bound from above. Where tests were counted they
/// decide and times stand beside them. Cannot be told from fewer than three points or from a standard error
/// above 0.25.
Claim judge_bounds(const std::string& paper, const std::vector<Growth>& growths);

/// Row by row: quantity, fitted power and the formula's over the same sizes.
Table exponents_table(const std::string& name, const std::string& caption, const std::string& size,
                      const std::vector<Growth>& growths);

/// `1,000 to 1,000,000`
std::string sizes_of(const Points& points);

}  // namespace supple::experiments
