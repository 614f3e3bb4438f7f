#pragma once

#include <vector>

#include "supple/simulation.hpp"

namespace supple::cli {

/// A table of the energy of each body of masses and springs, at its construction and when it is printed.
class EnergyTable {
 public:
  explicit EnergyTable(const Simulation& simulation);

  /// Prints to standard output; prints nothing when there is no such body.
  void print(const Simulation& simulation) const;

 private:
  struct Row {
    ObjectId object;
    double total_at_start = 0;
  };
  std::vector<Row> rows_;
};

}  // namespace supple::cli
