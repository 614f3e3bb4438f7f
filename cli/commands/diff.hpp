#pragma once

#include "options/options.hpp"

namespace supple::cli {

/// Runs `supple diff`; returns the exit status. Throws `Error` for a file that is not a recording.
int run_diff(const DiffOptions& options);

}  // namespace supple::cli
