#pragma once

#include "options/options.hpp"

namespace supple::cli {

/// Runs `supple ccd-queries`; returns the exit status. Throws `Error` for unusable input.
int run_ccd_queries(const CcdQueriesOptions& options);

}  // namespace supple::cli
