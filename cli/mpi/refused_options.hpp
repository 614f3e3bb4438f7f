#pragma once

#include "inputs/inputs.hpp"
#include "options/options.hpp"

namespace supple::cli {

/// Throws `Error` for what several ranks do not have. `has_steps` says that objects move.
void refuse_options(const DetectionOptions& options, const Input& input, bool has_steps);

}  // namespace supple::cli
