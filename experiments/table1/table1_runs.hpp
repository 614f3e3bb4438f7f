#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "base/interruption.hpp"
#include "fit.hpp"
#include "inputs/inputs.hpp"
#include "supple/simulation.hpp"
#include "table.hpp"
#include "table1/table1_options.hpp"

namespace supple::experiments {

/// How long a run lasts: in simulated time, or by the clock of its detection and motion together.
enum class RunClock { simulated, program };

/// The strain of edges in a run, sampled every 25 steps; 0 without bodies of masses and springs.
struct RunStrain {
  double mean = 0;             ///< over bodies and samples, of the mean over the edges of a body
  double least = 0, most = 0;  ///< of the means of the samples from the second second on
  double largest = 0;          ///< of an edge
};

/// Numbers of collisions that begin in one run.
struct RunCounts {
  std::uint64_t broad = 0;   ///< pairs of objects whose volumes begin to overlap
  std::uint64_t narrow = 0;  ///< pairs whose octrees' leaves begin to overlap: the paper's output
  std::uint64_t exact = 0;   ///< pairs whose triangles begin to intersect; 0 in runs by the clock
  std::uint64_t steps = 0;
  double detection_seconds = 0;  ///< of all steps: refit, broad phase and narrow phase, not the exact stage
  double motion_seconds = 0;     ///< of all steps
  RunStrain strain{};
  std::string failure{};  ///< why the motion failed; empty on success
};

/// The collisions of a run in ten minutes, the time of the paper's runs, by each clock.
double in_ten_minutes_of_detection(std::uint64_t collisions, const RunCounts& run);
double in_ten_minutes_of_program(std::uint64_t collisions, const RunCounts& run);

/// One way to find the collisions of a run.
struct Variant {
  Table1Method method;
  BoundingVolume volume;
};

/// The simulation of an input as a variant sees it; its options are set in the input.
Simulation build_variant(cli::Input& input, const Variant& variant, std::uint32_t threads);

/// One run of a scene, which `change` may change. All variants see the same motion; the counts of a variant
/// end when `go_on(its counts so far)` returns false, and the run ends after the last. The counts are the
/// same for any number of threads. `variants` is not empty; all have one integrator.
std::vector<RunCounts> run_scene(const Table1Scene& scene, std::span<const Variant> variants,
                                 std::uint64_t seed, std::uint32_t threads,
                                 const std::function<bool(const RunCounts&)>& go_on,
                                 const std::function<void(cli::Input&)>& change = {});

/// All runs of one scene with one kind of volume.
struct Runs {
  Table1Scene scene;
  bool is_first_size = true;  ///< no runs before these have the same scene in another size
  std::uint64_t objects = 0;
  std::optional<double> edge{};  ///< the longest of the border
  BoundingVolume volume{};
  double run_seconds = 0;  ///< of a run, by its clock
  std::vector<RunCounts> counts{};

  /// The numbers of the runs that did not break off.
  std::vector<double> numbers(std::uint64_t RunCounts::*member) const;
  Estimate estimate(std::uint64_t RunCounts::*member) const { return estimate_of(numbers(member)); }
  double seconds_for_one(std::uint64_t RunCounts::*member) const {
    return run_seconds / estimate(member).mean;
  }
};

/// Whether the runs are of pawns, fish and rabbits, as those of Table 1.
inline bool is_of_table(const Runs& runs) {
  return runs.scene.source == Table1Scene::Source::mixed && runs.is_first_size;
}
/// The runs of a scene in its first size with a kind of volume, or null.
const Runs* find(const std::vector<Runs>& all, const std::string& scene, BoundingVolume volume);

/// The table with one row per run. Only its columns of seconds depend on the machine.
Table runs_table(const std::vector<Runs>& all, std::uint64_t first_seed, RunClock clock);
/// `table1` or `table1_program`: the names of tables begin so.
std::string name_of(RunClock clock);

/// The complete runs, in the file of `runs_table`, which gets a row as soon as a run is complete.
class RunLog {
 public:
  /// Starts the file in a folder, or with `resume` keeps its rows. Throws `Error` when the file is not such a
  /// table.
  RunLog(const std::filesystem::path& folder, RunClock clock, bool resume);

  /// Null when the run is not complete.
  const RunCounts* find(const Runs& runs, std::uint64_t seed) const;
  void add(const Runs& runs, std::uint64_t seed, const RunCounts& counts);

 private:
  RunClock clock_;
  std::map<std::string, RunCounts> done_;  ///< by scene, edge, volume and seed
  std::optional<cli::OutputFile> file_;
};

/// Runs every scene with every kind of volume, for `simulated_seconds` per run. Runs are independent: each
/// has one thread, and several run in parallel. Runs in the log are not repeated. Nothing after an
/// interruption.
std::optional<std::vector<Runs>> run_by_steps(const Table1Options& options, RunLog& log,
                                              const cli::Interruption& interruption, bool show_progress);
/// The same for `program_clock` seconds per run, one run after the other. These runs have no exact stage, as
/// in the paper.
std::optional<std::vector<Runs>> run_by_clock(const Table1Options& options, RunLog& log,
                                              const cli::Interruption& interruption, bool show_progress);

}  // namespace supple::experiments
