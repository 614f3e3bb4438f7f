#pragma once

#include <string>

#include "inputs/inputs.hpp"

namespace supple::cli {

/// Replaces each object with `InputObject::splits` by its connected parts, in their order. A part is solid
/// when the object is and the part bounds a solid. Adds a note where parts of a solid that is not split
/// intersect. Throws `Error` for objects of a recording.
void split_parts(Input& input);

/// A sentence that names the parts that are solid, and why the others are not; empty without parts of solid
/// objects.
std::string describe_solid_parts(const Input& input);

}  // namespace supple::cli
