#pragma once

#include "inputs.hpp"
#include "options.hpp"
#include "supple/simulation.hpp"

namespace supple::cli {

/// Of an object of an input, as the command line has it.
ObjectOptions options_of(const InputObject& object, const MethodOptions& options);

/// A simulation of the objects of an input, in their order, each where it is at the start. Throws `Error` as
/// `Simulation::add` does, or when a frame of a sequence is not what it should be.
Simulation build_simulation(const Input& input, const DetectionOptions& options);

}  // namespace supple::cli
