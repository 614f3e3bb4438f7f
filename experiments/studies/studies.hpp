#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "results.hpp"
#include "work.hpp"

namespace supple::experiments {

struct BroadPhasesOptions {
  std::vector<std::size_t> object_counts{3,    6,    9,      20,     50,      100,     200,      500,
                                         1000, 3162, 10'000, 31'623, 100'000, 316'228, 1'000'000};
  double longest_step = 5;  ///< seconds; a method stops before a size at which n² work would take longer
  int rounds = 9;           ///< ≥ 2
  std::uint64_t seed = 1;
};

/// A step of all methods at all sizes, in turn on the same boxes: those of the library, and plain programs as
/// of 2007. All boxes move; at some sizes also one in a hundred. One row is a round of a method, whose
/// seconds are those of a step; round 0 is the first step, without a step before it. Throws `Error` when two
/// methods find different numbers of pairs.
Table measure_broad_phases(const BroadPhasesOptions& options, Work& work);

/// Times and tests against the number of objects and of vertices.
Results run_scaling(const Request& request);

/// Trees of two, four and eight children, of objects and of the scene, with one thread. Times are the least
/// of the rounds.
Results run_arity(const Request& request);

/// All kinds of bounding volumes and all ways to build the octrees of objects on the same frames, with one
/// thread. Times are the least of the rounds.
Results run_volumes(const Request& request);

/// What single claims of the paper need that no other experiment measures, with one thread.
Results run_claims(const Request& request);

struct ClaimsOptions {
  std::size_t volumes = 4096;            ///< of each kind, for the cost of one test
  std::size_t spheres = 100'000;         ///< in the scene octree
  std::uint32_t largest_frequency = 64;  ///< of the spheres: 20 f² triangles
  double motion_seconds = 10;            ///< simulated, for integrators, areas and strains
  int rounds = 9;                        ///< ≥ 2
  std::uint64_t seed = 1;
};
// Those about motion; each runs alone.
Table translation_of_volumes(const ClaimsOptions& options);
Table loops(const ClaimsOptions& options);
Table steps_of_models(const ClaimsOptions& options);
Table energies_of_integrators(const ClaimsOptions& options);
Table areas_and_strains(const ClaimsOptions& options);

}  // namespace supple::experiments
