#pragma once

#include "inputs.hpp"
#include "options.hpp"
#include "supple/simulation.hpp"

namespace supple::cli {

/// Puts the options that the command line gives in the place of the input's.
void apply(const MethodOptions& options, Input& input);

/// A simulation of the objects of an input, in their order, each where it is at the start. Throws `Error` as
/// `Simulation::add` does, or when a frame of a sequence is not what it should be.
Simulation build_simulation(const Input& input);

}  // namespace supple::cli
