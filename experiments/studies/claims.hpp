#pragma once

#include <cstddef>
#include <cstdint>

#include "results.hpp"

namespace supple::experiments {

struct ClaimsOptions {
  std::size_t volumes = 4096;            ///< of each kind, for the cost of one test
  std::size_t spheres = 100'000;         ///< in the scene octree
  std::uint32_t largest_frequency = 64;  ///< of the spheres: 20 f² triangles
  double motion_seconds = 10;            ///< simulated, for integrators, areas and strains
  int rounds = 9;                        ///< ≥ 2
  std::uint64_t seed = 1;
};

ClaimsOptions claims_options(bool quick);

/// What single claims of the paper need that no other experiment measures, with one thread.
Results run_claims(const ClaimsOptions& options, bool show_progress);

// Volumes and octrees; each runs alone.
Table cost_of_tests(const ClaimsOptions& options);
Table region_tests(const ClaimsOptions& options);
Table depths(const ClaimsOptions& options);
Table regions_of_objects(const ClaimsOptions& options);
Table spheres_of_the_equations(const ClaimsOptions& options);
// Motion.
Table translation_of_volumes(const ClaimsOptions& options);
Table loops(const ClaimsOptions& options);
Table steps_of_models(const ClaimsOptions& options);
Table energies_of_integrators(const ClaimsOptions& options);
Table areas_and_strains(const ClaimsOptions& options);

}  // namespace supple::experiments
