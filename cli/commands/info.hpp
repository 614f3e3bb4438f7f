#pragma once

#include "options/options.hpp"

namespace supple::cli {

/// Runs `supple info`; returns the exit status. Throws `Error` for unusable input.
int run_info(const InfoOptions& options);

}  // namespace supple::cli
