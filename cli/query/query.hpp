#pragma once

#include "options/options.hpp"

namespace supple::cli {

/// Runs `supple query`; returns the exit status. Throws `Error` for unusable input.
int run_query(const QueryOptions& options);

}  // namespace supple::cli
