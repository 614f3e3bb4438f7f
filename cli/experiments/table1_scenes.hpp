#pragma once

#include <string>

#include "inputs.hpp"

namespace supple::experiments {

/// A scene of section 7 by the name of its file in scenes/, read from the text built into the program. Throws
/// `Error` when there is none of that name.
cli::Input table1_scene(const std::string& name);

}  // namespace supple::experiments
