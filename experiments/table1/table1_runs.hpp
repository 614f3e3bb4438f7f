#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "base/interruption.hpp"
#include "inputs/inputs.hpp"
#include "results.hpp"
#include "supple/simulation.hpp"
#include "table1/table1_options.hpp"

namespace supple::experiments {

/// How long a run lasts: in simulated time, or by the clock of its detection and motion together.
enum class RunClock { simulated, program };

constexpr std::uint64_t strain_every = 25;  // steps

/// Numbers of collisions that begin in one run. Times are those of the processor.
struct RunCounts {
  std::uint64_t broad = 0;   ///< pairs of objects whose volumes begin to overlap
  std::uint64_t narrow = 0;  ///< pairs whose octrees' leaves begin to overlap: the paper's output
  std::uint64_t exact = 0;   ///< pairs whose triangles begin to intersect; 0 in runs by the clock
  std::uint64_t steps = 0;
  double bounds_seconds = 0;     ///< of the loop that makes the boxes of the bodies, when it is fused
  double detection_seconds = 0;  ///< of all steps: refit, broad phase and narrow phase, not the exact stage
  double motion_seconds = 0;     ///< of all steps, with its own loop that makes the boxes
  double mean_strain = 0, largest_strain = 0;  ///< of edges, each `strain_every` steps; 0 without bodies
  std::string failure{};                       ///< why the motion failed; empty on success
};

/// One way to find the collisions of a run.
struct Variant {
  Table1Method method;
  BoundingVolume volume;
  std::string setting{};  ///< its name in the table
};

/// The simulation of an input as a variant sees it, with one thread; its options are set in the input.
Simulation build_variant(cli::Input& input, const Variant& variant);

/// A scene, what changes in it, and the variants that see the same motion; at least one, all of one
/// integrator.
struct Motion {
  Table1Scene scene;
  std::vector<Variant> variants;
  std::function<void(cli::Input&)> change{};
  double seconds = 600;  ///< of each run, by its clock
};

/// One run of a motion. Each variant detects after each step, in turn, forwards and backwards; its counts end
/// when `go_on(its counts so far)` returns false, and the run ends after the last. With `exact`, the contacts
/// of each variant are counted, too, outside of its clock.
std::vector<RunCounts> run_scene(const Motion& motion, std::uint64_t seed, bool exact,
                                 const std::function<bool(const RunCounts&)>& go_on);

/// The complete runs, in a CSV file that gets a row as soon as a run is complete.
class RunLog {
 public:
  /// Starts the file in a folder, which is created if necessary, or with `resume` keeps its rows. `scenes` is
  /// a hash of their texts. Throws `Error` when the file is not such a table, or when its head names another
  /// command, commit or machine, or other scenes.
  RunLog(const std::filesystem::path& folder, const std::string& name, std::uint64_t scenes, bool resume);

  bool has(const std::vector<Cell>& key) const;
  void add(std::vector<Cell> key, const RunCounts& counts);

 private:
  std::string text_;  ///< of the complete lines
  std::optional<cli::OutputFile> file_;
};

struct RunOptions {
  std::filesystem::path folder;
  std::string name;     ///< of the log
  bool resume = false;  ///< go on with the log
  RunClock clock = RunClock::simulated;
  std::uint32_t runs = 5;  ///< of each motion; run k has the seed `seed` + k
  std::uint64_t seed = 1;
  bool exact = false;
  std::optional<std::uint32_t> threads{};  ///< parallel runs of one thread each; none: one per core
};

/// Runs all motions that are not in the log. Runs by the clock of the program run one after the other.
/// Returns false after an interruption. Throws `Error` as `read_scene` and `RunLog` do.
bool run_all(const std::vector<Motion>& motions, const RunOptions& options,
             const cli::Interruption& interruption, bool show_progress);

/// Runs scenes with each kind of volume and counts the collisions that begin: table1_runs.csv in simulated
/// time, table1_program_runs.csv by the clock of the program. With `resume`, what is complete in the folder
/// is not repeated. Returns false after an interruption.
bool run_table1(const Table1Options& options, const Request& request, bool resume,
                const cli::Interruption& interruption);

/// The setting that the paper does not state may give its ratio of spheres to boxes: runs 3, 6 and 9 objects
/// with other sizes of the scene, speeds, both together, stiffness and forces of the bodies, levels and
/// leaves of the octrees: sensitivity.csv, and with `resume` only what it does not have.
bool run_sensitivity(const Table1Options& options, const Request& request, bool resume,
                     const cli::Interruption& interruption);

}  // namespace supple::experiments
