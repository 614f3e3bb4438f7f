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

std::string and_others(std::uint64_t count) {
  if (count == 0) return "";
  return " and " + std::to_string(count) + (count == 1 ? " other object" : " other objects");
}

}  // namespace

std::optional<std::string> warning_of_long_steps(const Simulation& simulation) {
  const double time_step = simulation.options().time_step;
  double shortest = time_step;
  ObjectId worst;
  std::uint64_t count = 0;
  for (const ObjectId object : simulation.scene().objects()) {
    const MassSpringBody* const body = simulation.body(object);
    if (!body || body->stable_step() >= time_step) continue;
    ++count;
    if (body->stable_step() >= shortest) continue;
    shortest = body->stable_step();
    worst = object;
  }
  if (count == 0) return std::nullopt;
  const double substeps = std::ceil(time_step / shortest * simulation.body(worst)->options().substeps);
  return "time_step " + digits_of(time_step) + " is too long for " + simulation.scene().name(worst) +
         and_others(count - 1) + ": its motion is stable up to " +
         digits_of(shortest, std::chars_format::general, 3) +
         "; give it substeps = " + digits_of(substeps, std::chars_format::fixed) +
         ", a lower stiffness or integrator = \"backward_euler\", or shorten time_step";
}

}  // namespace supple::viewer
