#pragma once

#include "moving/ranks.hpp"
#include "options/options.hpp"

namespace supple::cli {

/// Runs `supple simulate`; returns the exit status. Throws `Error` for unusable input.
int run_simulate(const SimulateOptions& options, Ranks& ranks);

}  // namespace supple::cli
