#pragma once

#include <utility>
#include <vector>

#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"

namespace supple::cli {

/// A table of the energy of each body of masses and springs at the start and at the end.
class EnergyTable {
 public:
  explicit EnergyTable(const Input& input) : input_(input) {}

  void start(std::vector<BodyEnergy> energies) { start_ = std::move(energies); }
  void end(std::vector<BodyEnergy> energies) { end_ = std::move(energies); }
  /// Prints to standard output; prints nothing when there is no such body.
  void print() const;

 private:
  const Input& input_;
  std::vector<BodyEnergy> start_, end_;  ///< of the same bodies
};

}  // namespace supple::cli
