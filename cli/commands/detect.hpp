#pragma once

#include "moving/ranks.hpp"
#include "options/options.hpp"

namespace supple::cli {

/// Runs `supple detect`; returns the exit status. Throws `Error` for unusable input.
int run_detect(const DetectOptions& options, Ranks& ranks);

}  // namespace supple::cli
