#pragma once

#include <optional>
#include <string>

#include "supple/simulation.hpp"

namespace supple::viewer {

/// A sentence about bodies that will blow up because the steps are too long for them, which names the worst
/// one and what mends it; nothing when there are none.
std::optional<std::string> warning_of_long_steps(const Simulation& simulation);

}  // namespace supple::viewer
