#pragma once

#include "arguments.hpp"
#include "messages/json_text.hpp"
#include "program.hpp"

namespace supple::viewer {

/// The members of the command `break`. Those that are missing or null are off.
BreakOptions read_breaks(Arguments& arguments);
/// Writes `breaks`, the description and the value of each member of the command, and `break_objects`.
void write_breaks(const BreakOptions& breaks, JsonText& json);
/// Writes the members of the answer to `program`.
void answer_program(const ProgramState& state, JsonText& json);

}  // namespace supple::viewer
