#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/report.hpp"
#include "experiments/work.hpp"
#include "supple/options.hpp"
#include "supple/simulation.hpp"

namespace supple::experiments {

struct Table1Options {
  std::vector<std::string> scenes;  ///< of `table1_scene_names`
  std::uint32_t runs = 5;           ///< ≥ 1; run k has the seed `seed` + k
  double simulated_seconds = 600;
  std::optional<double> wall_clock{};  ///< seconds a run; none: by events only
  std::uint32_t threads = 0;  ///< runs by events at a time, or threads of one by the clock; 0: one a core
  std::uint64_t seed = 1;
};

/// The scenes of section 7, built into the program from the scene files of the same names.
std::vector<std::string> table1_scene_names();

Table1Options table1_options(bool quick);

/// Collisions that begin in one run.
struct RunCounts {
  std::uint64_t broad = 0;   ///< pairs of objects whose volumes begin to overlap
  std::uint64_t narrow = 0;  ///< pairs of which leaves of both octrees begin to overlap: the paper's output
  std::uint64_t exact = 0;   ///< pairs whose triangles begin to intersect
  std::uint64_t steps = 0;
  std::string failure{};  ///< why the motion broke off; empty: it did not

  bool operator==(const RunCounts&) const = default;
};

/// One run of a scene, stopped when `go_on(steps taken)` says no. Every octree's leaves are single triangles,
/// as the paper's are. The counts are the same for any number of threads.
RunCounts run_scene(const std::string& scene, BoundingVolume volume, std::uint64_t seed,
                    std::uint32_t threads, const std::function<bool(std::uint64_t steps)>& go_on);

/// Collisions of 3, 6 and 9 objects, and of more complex ones, by boxes and by spheres.
Report run_table1(const Table1Options& options, bool show_progress);

}  // namespace supple::experiments
