#pragma once

#include "options/options.hpp"

namespace supple::cli {

/// Runs `supple view`: serves a page until it is interrupted, or writes a page to a file. Returns the exit
/// status. Throws `Error` for unusable input.
int run_view(const ViewOptions& options);

}  // namespace supple::cli
