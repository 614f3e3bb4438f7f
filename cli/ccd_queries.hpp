#pragma once

#include "options.hpp"

namespace supple::cli {

/// `supple ccd-queries`: returns the exit status, throws `Error` for input that cannot be used.
int run_ccd_queries(const CcdQueriesOptions& options);

}  // namespace supple::cli
