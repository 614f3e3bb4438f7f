#pragma once

#include <CLI/CLI.hpp>

#include "experiment.hpp"
#include "options/option_kinds.hpp"

namespace supple::experiments {

/// Adds the options and the footer of the help to the command `experiment`.
void add_options(CLI::App& experiment, ExperimentOptions& options, cli::Dependences& dependences);

}  // namespace supple::experiments
