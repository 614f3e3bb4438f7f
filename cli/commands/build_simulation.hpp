#pragma once

#include "inputs/inputs.hpp"
#include "options/options.hpp"
#include "supple/recording.hpp"
#include "supple/simulation.hpp"

namespace supple::cli {

/// Replaces options of the input by those of the command line.
void apply(const MethodOptions& options, Input& input);
/// Replaces options of all objects, and splits the objects into their parts where wanted.
void apply_to_objects(const viewer::Overrides<ObjectOptions>& given, bool as_2007, bool parts, Input& input);

/// An object of an input, for the header of a recording: at the positions at which `add_object` adds it to a
/// simulation with this border.
RecordedObject recorded_object(ObjectId id, const InputObject& object, const std::optional<Border>& border);

/// Adds an object of an input at its start positions. Throws `Error` as `Simulation::add` does, or when a
/// frame of a sequence does not fit the object.
ObjectId add_object(Simulation& simulation, const InputObject& object);
/// The same for a simulation that only moves: without triangles, edges and points, as far as the motion does
/// not need them.
ObjectId add_positions(Simulation& simulation, const InputObject& object);
/// Makes a simulation of the objects of an input, in their order. Throws `Error` as `add_object` does.
Simulation build_simulation(const Input& input);

}  // namespace supple::cli
