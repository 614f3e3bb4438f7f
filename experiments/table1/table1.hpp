#pragma once

#include <filesystem>
#include <optional>

#include "base/interruption.hpp"
#include "report.hpp"
#include "table1/table1_options.hpp"

namespace supple::experiments {

/// Counts collisions of 3, 6 and 9 objects, and of other scenes, with several kinds of volumes. Each complete
/// run goes into a CSV file in the folder, which is created if necessary. With `resume`, the runs in the
/// folder are not repeated; the options must be those of the folder. Returns nothing after an interruption.
std::optional<Report> run_table1(const Table1Options& options, const std::filesystem::path& folder,
                                 bool resume, const cli::Interruption& interruption, bool show_progress);

}  // namespace supple::experiments
