#include "messages/long_steps.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace supple::viewer {
namespace {

/// Formats with `std::to_chars`. Without a format: the fewest digits that identify the number.
std::string digits_of(double value, auto... format) {
  std::array<char, 400> text;  // large enough for any exponent
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, format...).ptr};
}

}  // namespace

std::string and_others(std::uint64_t count) {
  if (count == 0) return "";
  return " and " + std::to_string(count) + (count == 1 ? " other object" : " other objects");
}

LongSteps find_long_steps(const Simulation& simulation) {
  LongSteps steps;
  steps.stable_step = simulation.options().time_step;
  for (const ObjectId object : simulation.scene().objects()) {
    const MassSpringBody* const body = simulation.body(object);
    if (!body || body->stable_step() >= simulation.options().time_step) continue;
    ++steps.count;
    if (body->stable_step() >= steps.stable_step) continue;
    steps.stable_step = body->stable_step();
    steps.worst = object;
    steps.substeps = body->options().substeps;
  }
  return steps;
}

std::optional<std::string> warning_of_long_steps(const LongSteps& steps, double time_step,
                                                 const std::string& worst_name) {
  if (steps.count == 0) return std::nullopt;
  const double substeps = std::ceil(time_step / steps.stable_step * steps.substeps);
  return "time_step " + digits_of(time_step) + " is too long for " + worst_name +
         and_others(steps.count - 1) + ": its motion is stable up to " +
         digits_of(steps.stable_step, std::chars_format::general, 3) +
         "; give it substeps = " + digits_of(substeps, std::chars_format::fixed) +
         ", a lower stiffness or integrator = \"backward_euler\", or shorten time_step";
}

std::optional<std::string> warning_of_long_steps(const Simulation& simulation) {
  const LongSteps steps = find_long_steps(simulation);
  return warning_of_long_steps(steps, simulation.options().time_step,
                               steps.count > 0 ? simulation.scene().options(steps.worst).name : "");
}

}  // namespace supple::viewer
