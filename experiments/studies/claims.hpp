#pragma once

#include <cstdint>
#include <vector>

#include "report.hpp"

namespace supple::experiments {

struct ClaimsOptions {
  std::size_t volumes = 4096;     ///< of each kind, for the cost of one test
  std::size_t spheres = 100'000;  ///< in the scene octree
  /// Boxes for the comparison of sweeps, ascending.
  std::vector<std::size_t> swept_boxes{100, 1000, 10'000, 30'000};
  std::uint32_t largest_frequency = 64;  ///< of the spheres: 20 f² triangles
  double motion_seconds = 10;            ///< simulated, for the stability of integrators
  int rounds = 9;                        ///< ≥ 1; the fastest counts
  std::uint64_t seed = 1;
};

ClaimsOptions claims_options(bool quick);

/// Measures single claims of the paper that need no experiment of their own.
Report run_claims(const ClaimsOptions& options, bool show_progress);

/// One claim with its measurements.
struct Finding {
  Claim claim;
  Table table;
};

// Volumes and octrees; each runs alone.
Finding cost_of_tests(const ClaimsOptions& options);
Finding region_tests(const ClaimsOptions& options);
Finding sweeps_on_one_axis_and_three(const ClaimsOptions& options);
Finding depth_of_small_triangles(const ClaimsOptions& options);
Finding depth_of_many_triangles(const ClaimsOptions& options);
Finding regions_of_objects(const ClaimsOptions& options);
Finding leaves_of_levels(const ClaimsOptions& options);
Finding spheres_of_the_equations(const ClaimsOptions& options);
// Motion.
Finding translation_of_volumes(const ClaimsOptions& options);
Finding one_loop(const ClaimsOptions& options);
Finding primitives_and_motion(const ClaimsOptions& options);
Finding stability_of_integrators(const ClaimsOptions& options);

}  // namespace supple::experiments
