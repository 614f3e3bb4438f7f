#pragma once

#include "inputs/inputs.hpp"
#include "options/options.hpp"

namespace supple::cli {

/// Throws `Error` for what several ranks do not have.
void refuse_options(const DetectionOptions& options, const Input& input);

}  // namespace supple::cli
