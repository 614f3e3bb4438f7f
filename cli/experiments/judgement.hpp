#pragma once

#include <functional>
#include <string>

#include "experiments/fit.hpp"
#include "experiments/report.hpp"

namespace supple::experiments {

/// What was measured against the size, and the formula that the paper gives for it.
struct Growth {
  std::string quantity;  ///< `time of a step, brute force`
  std::string unit;
  Points points;
  std::string formula;                         ///< `n log n`; empty: no claim
  std::function<double(double)> formula_at{};  ///< up to a factor
};

/// An exponent above that of the formula by no more than this, or twice its standard error, is within a
/// bound.
inline constexpr double exponent_tolerance = 0.1;

/// Whether the measured exponents are within the formulas', a bound from above: each point of each growth
/// counts. Cannot be told from fewer than three points, or when the standard error is above 0.25.
Claim judge_bounds(const std::string& paper, const std::vector<Growth>& growths);

/// Row by row: quantity, fitted power and the formula's over the same sizes.
Table exponents_table(const std::string& name, const std::string& caption, const std::string& size,
                      const std::vector<Growth>& growths);

}  // namespace supple::experiments
