#pragma once

#include <optional>
#include <string>

#include "supple/simulation.hpp"

namespace supple::viewer {

/// A warning about bodies whose time step exceeds their stable step: names the worst body and the remedy.
/// Empty when all steps are stable.
std::optional<std::string> warning_of_long_steps(const Simulation& simulation);

}  // namespace supple::viewer
