#include "experiments/judgement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace supple::experiments {
namespace {

Verdict judge(const PowerLaw& fit, double formula) {
  if (!(fit.standard_error <= 0.25)) return Verdict::cannot_tell;
  return verdict_of(fit.exponent - formula <= std::max(exponent_tolerance, 2 * fit.standard_error));
}

/// One that does not hold decides, then one that cannot be told.
Verdict both(Verdict a, Verdict b) {
  if (a == Verdict::does_not_hold || b == Verdict::does_not_hold) return Verdict::does_not_hold;
  return a == Verdict::cannot_tell ? a : b;
}

std::string sizes_of(const Points& points) {
  const auto [low, high] = std::minmax_element(points.begin(), points.end());
  return fmt::format("{} to {}", rounded(low->first), rounded(high->first, 7));
}

}  // namespace

Claim judge_bounds(const std::string& paper, const std::vector<Growth>& growths) {
  Claim claim{paper, Verdict::holds, {}};
  for (const Growth& growth : growths) {
    const PowerLaw fit = fit_power_law(growth.points);
    const double formula = exponent_of(growth.formula_at, growth.points);
    claim.verdict = both(claim.verdict, judge(fit, formula));
    if (!claim.reason.empty()) claim.reason += ' ';
    if (fit.points < 3) {
      claim.reason += fmt::format("{}: {} sizes measured, too few for a fit.", growth.quantity, fit.points);
      continue;
    }
    claim.reason += fmt::format("{} grows with exponent {}; {} has {:.2f} over the same sizes.",
                                growth.quantity, text_of(fit), growth.formula, formula);
  }
  return claim;
}

Table exponents_table(const std::string& name, const std::string& caption, const std::string& size,
                      const std::vector<Growth>& growths) {
  Table table{name,
              caption,
              {{"quantity", "Quantity"},
               {"unit", "Unit"},
               {"sizes", size},
               {"points", "Points"},
               {"exponent", "Exponent", 3},
               {"standard_error", "± error", 2},
               {"formula", "The paper's"},
               {"formula_exponent", "its exponent", 3}}};
  for (const Growth& growth : growths) {
    if (growth.points.empty()) continue;
    const PowerLaw fit = fit_power_law(growth.points);
    const bool claimed = static_cast<bool>(growth.formula_at);
    table.add({growth.quantity, growth.unit, sizes_of(growth.points), static_cast<std::uint64_t>(fit.points),
               fit.exponent, fit.standard_error, claimed ? Cell(growth.formula) : Cell(),
               claimed ? Cell(exponent_of(growth.formula_at, growth.points)) : Cell()});
  }
  return table;
}

}  // namespace supple::experiments
