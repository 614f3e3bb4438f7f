#pragma once

#include <CLI/CLI.hpp>

#include "experiments/experiment.hpp"
#include "option_kinds.hpp"

namespace supple::experiments {

/// The subcommand `experiment`, its options and help.
CLI::App* add_experiment(CLI::App& program, ExperimentOptions& options, cli::Dependences& dependences);

}  // namespace supple::experiments
