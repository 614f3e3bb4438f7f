#pragma once

#include "options.hpp"

namespace supple::cli {

/// `supple diff`: returns the exit status, throws `Error` for a file that is no recording.
int run_diff(const DiffOptions& options);

}  // namespace supple::cli
