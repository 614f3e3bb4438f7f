#include "moving/moving_objects.hpp"

#include "commands/build_simulation.hpp"
#include "inputs/half_turns.hpp"
#include "inputs/inputs.hpp"
#include "session/messages/long_steps.hpp"

namespace supple::cli {

MovingObjects::MovingObjects(const Input& input) : simulation_(build_simulation(input)) {
  turns_ = std::make_unique<HalfTurns>(simulation_, input);
}

MovingObjects::MovingObjects(const SimulationOptions& options) : simulation_(options) {}
MovingObjects::~MovingObjects() = default;

void MovingObjects::remember_positions() {
  turns_->remember_positions();
}

std::vector<ObjectId> MovingObjects::turned() {
  return turns_->find();
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
