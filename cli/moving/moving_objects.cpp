#include "moving/moving_objects.hpp"

#include "commands/build_simulation.hpp"
#include "session/messages/long_steps.hpp"

namespace supple::cli {

MovingObjects::MovingObjects(const Input& input) : simulation_(build_simulation(input)) {
  turns_.emplace(simulation_, input);
}

std::vector<BodyEnergy> MovingObjects::energies() {
  std::vector<BodyEnergy> energies;
  for (const ObjectId object : simulation_.scene().objects()) {
    if (const MassSpringBody* const body = simulation_.body(object))
      energies.push_back({object, body->energy()});
  }
  return energies;
}

std::optional<std::string> MovingObjects::warning_of_long_steps() {
  return viewer::warning_of_long_steps(simulation_);
}

}  // namespace supple::cli
