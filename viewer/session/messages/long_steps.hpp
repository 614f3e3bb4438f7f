#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "supple/simulation.hpp"

namespace supple::viewer {

/// The bodies of a simulation whose time step exceeds their stable step.
struct LongSteps {
  std::uint64_t count = 0;  ///< of bodies
  ObjectId worst;           ///< of them: the first with the shortest stable step
  double stable_step = 0;   ///< of the worst
  std::uint32_t substeps = 1;
};

LongSteps find_long_steps(const Simulation& simulation);
/// A warning that names the worst body and the remedy. Empty when all steps are stable.
std::optional<std::string> warning_of_long_steps(const LongSteps& steps, double time_step,
                                                 const std::string& worst_name);
/// The same for a simulation.
std::optional<std::string> warning_of_long_steps(const Simulation& simulation);

/// ` and 2 other objects`; empty for none.
std::string and_others(std::uint64_t count);

}  // namespace supple::viewer
