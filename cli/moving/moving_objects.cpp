#include "moving/moving_objects.hpp"

#include <cmath>

#include "commands/build_simulation.hpp"
#include "inputs/half_turns.hpp"
#include "inputs/inputs.hpp"
#include "session/messages/long_steps.hpp"

namespace supple::cli {

MovingObjects::MovingObjects(const Input& input) : simulation_(build_simulation(input)) {
  find_spins(input.objects);
}

void MovingObjects::find_spins(const std::vector<InputObject>& objects) {
  before_.resize(objects.size());
  for (const InputObject& object : objects) {
    const auto* const rigid = motion_of<RigidMotion>(object);
    // The random spin has any direction.
    const double least_spin = rigid != nullptr ? std::fabs(norm(rigid->spin) - rigid->random_spin) : 0;
    spins_.push_back(least_spin * simulation_.options().time_step > 120);
  }
}

void MovingObjects::remember_positions() {
  for (const ObjectId object : simulation_.scene().objects()) {
    const std::span<const Vec3d> positions = simulation_.positions(object);
    before_[object.index].assign(positions.begin(), positions.end());
  }
}

std::vector<ObjectId> MovingObjects::turned() {
  std::vector<ObjectId> turned = simulation_.scene().objects();
  std::erase_if(turned, [&](ObjectId object) {
    return !spins_[object.index] && !turns_too_far(before_[object.index], simulation_.positions(object));
  });
  return turned;
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
