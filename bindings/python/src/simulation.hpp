#pragma once

#include "supple/simulation.hpp"

#include <map>
#include <memory>

#include "calls.hpp"
#include "scene.hpp"

namespace supple::python {

struct SimulationState {
  explicit SimulationState(const SimulationOptions& options) : simulation(options) {}

  Simulation simulation;
  CallGuard guard;
  LastLists last;
  std::map<ObjectId, HeldFunction> motions;
};

/// The simulation of Python.
class SimulationCore {
 public:
  explicit SimulationCore(const nb::dict& keywords);

  Simulation& simulation() { return state_->simulation; }
  std::shared_ptr<SimulationState> state() { return state_; }
  CallGuard& guard() { return state_->guard; }
  std::map<ObjectId, HeldFunction>& motions() { return state_->motions; }
  template <class Visit>
  void for_each_held(const Visit& visit) const {
    for (const auto& [id, motion] : state_->motions) visit(*motion);
  }
  template <class Advance>
  std::unique_ptr<Result> run(const nb::dict& keywords, const char* where, Stop* stop,
                              const Advance& advance);

 private:
  std::shared_ptr<SimulationState> state_;
};

}  // namespace supple::python
