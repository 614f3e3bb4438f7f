#pragma once

#include <filesystem>

#include "base/interruption.hpp"
#include "table1/table1_options.hpp"

namespace supple::experiments {

/// Runs scenes with each kind of volume and counts the collisions that begin: table1_runs.csv in simulated
/// time, table1_program_runs.csv by the clock of the program, table1_options.csv. With `resume`, what is
/// complete in the folder is not repeated. Returns false after an interruption.
bool run_table1(const Table1Options& options, const std::filesystem::path& folder, bool resume,
                const cli::Interruption& interruption, bool show_progress);

/// The setting that the paper does not state may give its ratio of spheres to boxes: runs 3, 6 and 9 objects
/// with other sizes of the scene, speeds, both together, stiffness and forces of the bodies, levels and
/// leaves of the octrees: sensitivity.csv, and with `resume` only what it does not have.
bool run_sensitivity(const Table1Options& options, bool quick, const std::filesystem::path& folder,
                     bool resume, const cli::Interruption& interruption, bool show_progress);

}  // namespace supple::experiments
