#pragma once

#include "options/options.hpp"

namespace supple::cli {

/// Runs `supple render` and returns the exit status.
int run_render(const RenderOptions& options);

}  // namespace supple::cli
