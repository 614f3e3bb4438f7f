#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/paper_table.hpp"
#include "supple/options.hpp"

namespace supple::experiments {

struct Table1Options {
  std::vector<std::string> scenes;  ///< of `table1_scene_names`
  std::uint32_t runs = 5;           ///< ≥ 1; run k has the seed `seed` + k
  double simulated_seconds = 600;
  std::optional<double> wall_clock{};  ///< seconds of real time per run; none: count only by events
  std::uint32_t threads = 0;  ///< parallel runs by events, or threads of a run in real time; 0: one per core
  std::uint64_t seed = 1;
};

inline constexpr std::array table1_volumes{BoundingVolume::aabb, BoundingVolume::sphere};

/// Numbers of collisions that begin in one run.
struct RunCounts {
  std::uint64_t broad = 0;   ///< pairs of objects whose volumes begin to overlap
  std::uint64_t narrow = 0;  ///< pairs whose octrees' leaves begin to overlap: the paper's output
  std::uint64_t exact = 0;   ///< pairs whose triangles begin to intersect
  std::uint64_t steps = 0;
  std::string failure{};  ///< why the motion failed; empty on success

  bool operator==(const RunCounts&) const = default;
};

/// One run of a scene, until `go_on(steps taken)` returns false. The leaves of octrees are single triangles,
/// as in the paper. The counts are the same for any number of threads.
RunCounts run_scene(const std::string& scene, BoundingVolume volume, std::uint64_t seed,
                    std::uint32_t threads, const std::function<bool(std::uint64_t steps)>& go_on);

/// All runs of one scene with one kind of volume.
struct Runs {
  std::string scene;
  std::size_t objects = 0;
  std::string models;
  BoundingVolume volume{};
  std::vector<RunCounts> counts;
  double run_seconds = 0;  ///< of a run, simulated or in real time

  std::vector<double> numbers(std::uint64_t RunCounts::*member) const {
    std::vector<double> result;
    for (const RunCounts& run : counts) result.push_back(static_cast<double>(run.*member));
    return result;
  }
  double mean_of(std::uint64_t RunCounts::*member) const { return mean(numbers(member)); }
  double seconds_for_one(std::uint64_t RunCounts::*member) const { return run_seconds / mean_of(member); }
};

/// The runs of a scene with a kind of volume, or null.
const Runs* find(const std::vector<Runs>& all, const std::string& scene, BoundingVolume volume);

/// Runs every scene with both kinds of volumes, for `simulated_seconds` per run. Runs are independent: each
/// has one thread, and several run in parallel.
std::vector<Runs> run_by_events(const Table1Options& options, bool show_progress);
/// The same for `run_seconds` of real time per run, one run after the other.
std::vector<Runs> run_by_clock(const Table1Options& options, double run_seconds, bool show_progress);

}  // namespace supple::experiments
