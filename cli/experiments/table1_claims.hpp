#pragma once

#include <vector>

#include "experiments/report.hpp"
#include "experiments/table1_runs.hpp"

namespace supple::experiments {

/// What section 7 says, judged by the runs counted in simulated time, and by those by the clock where there
/// are any. Numbers of collisions differ from run to run: a claim about them holds or not when they are
/// beyond two standard errors.
std::vector<Claim> judge_table1(const std::vector<Runs>& events, const std::vector<Runs>& clock);

}  // namespace supple::experiments
