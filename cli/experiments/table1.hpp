#pragma once

#include <string>
#include <vector>

#include "experiments/report.hpp"
#include "experiments/table1_runs.hpp"

namespace supple::experiments {

/// The scenes of section 7, built into the program from the scene files of the same names.
std::vector<std::string> table1_scene_names();

Table1Options table1_options(bool quick);

/// Counts collisions of 3, 6 and 9 objects, and of more complex objects, with boxes and with spheres.
Report run_table1(const Table1Options& options, bool show_progress);

}  // namespace supple::experiments
