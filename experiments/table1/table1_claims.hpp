#pragma once

#include <vector>

#include "report.hpp"
#include "table1/table1_runs.hpp"

namespace supple::experiments {

/// Judges the claims of section 7 by the runs counted in simulated time and by those by the clock of
/// detection and motion, `program`. Claims about which no runs say anything are left out. Numbers of
/// collisions differ between runs: a claim about them is decided only beyond two standard errors.
std::vector<Claim> judge_table1(const std::vector<Runs>& steps, const std::vector<Runs>& program);

}  // namespace supple::experiments
