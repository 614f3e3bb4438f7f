#pragma once

#include <vector>

#include "supple/simulation.hpp"

namespace supple::cli {

/// The energy of each body of masses and springs, when the table is made and when it is printed.
class EnergyTable {
 public:
  explicit EnergyTable(const Simulation& simulation);

  /// To standard output; nothing when there is no such body.
  void print(const Simulation& simulation) const;

 private:
  struct Row {
    ObjectId object;
    double total_at_start = 0;
  };
  std::vector<Row> rows_;
};

}  // namespace supple::cli
