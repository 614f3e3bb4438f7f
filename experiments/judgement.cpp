#include "judgement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.hpp"

namespace supple::experiments {
namespace {

Verdict judge(const Growth& growth) {
  const PowerLaw fit = fit_power_law(growth.points);
  if (!(fit.standard_error <= 0.25)) return Verdict::cannot_tell;
  const double excess = fit.exponent - exponent_of(growth.formula_at, growth.points);
  if (excess <= std::max(exponent_tolerance, 2 * fit.standard_error)) return Verdict::holds;
  return growth.counts() || excess > std::max(time_tolerance, 3 * fit.standard_error) ? Verdict::does_not_hold
                                                                                      : Verdict::cannot_tell;
}

std::string described(const Growth& growth) {
  const PowerLaw fit = fit_power_law(growth.points);
  if (fit.points < 3)
    return fmt::format("{}: {} measured, too few for a fit.", growth.quantity,
                       cli::counted(fit.points, "size"));
  return fmt::format("{}: {} grow{} with exponent {}, {} over the same sizes with {:.2f}.", growth.quantity,
                     growth.unit, growth.counts() ? "" : "s", text_of(fit), growth.formula,
                     exponent_of(growth.formula_at, growth.points));
}

}  // namespace

Verdict below(const Estimate& quantity, double limit) {
  if (quantity.mean + 2 * quantity.error < limit) return Verdict::holds;
  return quantity.mean - 2 * quantity.error > limit ? Verdict::does_not_hold : Verdict::cannot_tell;
}

Verdict above(const Estimate& quantity, double limit) {
  return below({-quantity.mean, quantity.error}, -limit);
}

Verdict within(const Estimate& quantity, double low, double high) {
  return both(above(quantity, low), below(quantity, high));
}

Estimate ratio_of(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) ratios.push_back(a[i] / b[i]);
  return median_of(ratios);
}

Verdict both(Verdict a, Verdict b) {
  if (a == Verdict::does_not_hold || b == Verdict::does_not_hold) return Verdict::does_not_hold;
  return a == Verdict::cannot_tell ? a : b;
}

std::string sizes_of(const Points& points) {
  const auto low = std::min_element(points.begin(), points.end()),
             high = std::max_element(points.begin(), points.end());
  const auto whole = [](double size) { return cli::grouped(static_cast<std::uint64_t>(size)); };
  return fmt::format("{} to {}", whole(low->first), whole(high->first));
}

Claim judge_bounds(const std::string& id, const std::string& where, const std::string& paper,
                   const std::vector<Growth>& growths) {
  Claim claim{id, where, paper, Verdict::holds};
  double largest_excess = -std::numeric_limits<double>::infinity();
  const bool counted =
      std::any_of(growths.begin(), growths.end(), [](const Growth& g) { return g.counts(); });
  for (const Growth& growth : growths) {
    if (growth.counts() == counted) {
      claim.verdict = both(claim.verdict, judge(growth));
      const PowerLaw fit = fit_power_law(growth.points);
      const double formula = exponent_of(growth.formula_at, growth.points);
      if (fit.exponent - formula > largest_excess) {
        largest_excess = fit.exponent - formula;
        claim.number = Estimate{fit.exponent, fit.standard_error};
        claim.quantity =
            fmt::format("exponent of the {} ({} has {:.2f})", growth.unit, growth.formula, formula);
      }
    }
    if (!claim.reason.empty()) claim.reason += ' ';
    claim.reason += described(growth);
  }
  return claim;
}

Table exponents_table(const std::string& name, const std::string& caption, const std::string& size,
                      const std::vector<Growth>& growths) {
  Table table{name,
              caption,
              {{"quantity", "Quantity"},
               {"unit", "Of"},
               {"sizes", size},
               {"points", "Points"},
               {"exponent", "Exponent", 3},
               {"standard_error", "± error", 2},
               {"formula", "The paper"},
               {"formula_exponent", "exponent", 3}}};
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
