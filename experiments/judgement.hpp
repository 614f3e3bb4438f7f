#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fit.hpp"
#include "report.hpp"

namespace supple::experiments {

/// A measured quantity by size, and the paper's formula for it.
struct Growth {
  std::string quantity;  ///< `Brute force, step in motion`
  std::string unit;      ///< `tests`, or `time`
  Points points;
  std::string formula;                         ///< `n log n`; empty: no claim
  std::function<double(double)> formula_at{};  ///< up to a factor

  bool counts() const { return unit != "time"; }
};

/// A bound holds when the exponent exceeds that of the formula by at most this, or by twice its standard
/// error.
inline constexpr double exponent_tolerance = 0.1;
/// If the exponent of a time exceeds the formula by less than this, the claim is undecided, because caches
/// and fixed costs affect times.
inline constexpr double time_tolerance = 0.25;

/// Whether a quantity is below a limit by more than two standard errors: `holds`; above: `does_not_hold`;
/// `cannot_tell` within them or without an error.
Verdict below(const Estimate& quantity, double limit);
/// Whether a quantity is above a limit, in the same way.
Verdict above(const Estimate& quantity, double limit);
/// Whether a quantity is between two limits, in the same way.
Verdict within(const Estimate& quantity, double low, double high);
/// The median of the ratios a[i] / b[i] of times that were measured in turn.
Estimate ratio_of(const std::vector<double>& a, const std::vector<double>& b);

/// `does_not_hold` if one of the two is, otherwise `cannot_tell` if one of the two is.
Verdict both(Verdict a, Verdict b);

/// Whether the measured exponents are within the bounds of the formulas. If there are counts of tests, only
/// they decide, and times are shown beside them. Undecided with fewer than three points or a standard error
/// above 0.25. Its number is the exponent with the greatest excess over that of its formula.
Claim judge_bounds(const std::string& id, const std::string& where, const std::string& paper,
                   const std::vector<Growth>& growths);

/// One row per quantity: the fitted power, and the power of the formula over the same sizes.
Table exponents_table(const std::string& name, const std::string& caption, const std::string& size,
                      const std::vector<Growth>& growths);

/// `1,000 to 1,000,000`
std::string sizes_of(const Points& points);

}  // namespace supple::experiments
