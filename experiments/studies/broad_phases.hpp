#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "table.hpp"
#include "work.hpp"

namespace supple::experiments {

struct BroadPhasesOptions {
  std::vector<std::size_t> object_counts{3,     6,      9,      20,      50,      100,      200,      500,
                                         1000,  3162,   10'000, 31'623,  100'000, 316'228,  1'000'000};
  double longest_step = 5;  ///< seconds; a method stops before a size at which n² work would take longer
  int rounds = 9;           ///< ≥ 2
  std::uint64_t seed = 1;
};

/// A step of all methods at all sizes, in turn on the same boxes: those of the library, and plain programs as
/// of 2007. All boxes move; at some sizes also one in a hundred. One row is a round of a method, whose seconds
/// are those of a step; round 0 is the first step, without a step before it. Throws `Error` when two methods
/// find different numbers of pairs.
Table measure_broad_phases(const BroadPhasesOptions& options, Work& work);

}  // namespace supple::experiments
