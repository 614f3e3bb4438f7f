#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "report.hpp"
#include "work.hpp"

namespace supple::experiments {

/// The broad phase at the sizes of the paper.
struct FewObjectsOptions {
  std::vector<std::size_t> object_counts{3, 6, 9, 20, 50, 100, 200, 500, 1000};  ///< ascending
  int rounds = 9;                                                                ///< ≥ 2
  int steps_of_round = 30;  ///< at 1000 objects; more for fewer
  std::uint64_t seed = 1;
};

/// A step of all methods with one thread, in turn: the octree of 2007, today's, sweep and prune along one
/// axis and on three ([Bar92]), brute force, and the grid. The claims are about the octree of 2007.
struct FewObjects {
  Table table;
  Claim better_than_brute, comparable_with_sweep;
};
FewObjects measure_few_objects(const FewObjectsOptions& options, Work& work);
/// The steps of `work` that this takes.
std::uint64_t work_of(const FewObjectsOptions& options);

}  // namespace supple::experiments
