#include "table1/table1.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "base/files.hpp"
#include "machine.hpp"
#include "results.hpp"
#include "supple/error.hpp"
#include "table1/table1_runs.hpp"

namespace supple::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* options_file = "table1_options.csv";

/// Writes the options into the folder, which is created if necessary; or with `resume` compares them with
/// those of the folder.
void check_options(const Table1Options& options, const fs::path& folder, bool resume) {
  const fs::path path = folder / options_file;
  Table table{"table1_options", {"option", "value"}};
  for (const auto& [name, value] : describe(options)) table.add({name, value});
  const std::string text = csv_of(table);
  if (!resume) {
    make_folder(folder);
    write_file(path, csv_head() + text);
    return;
  }
  if (!fs::exists(path))
    throw Error(fmt::format("--resume: {} has no experiment table1; leave out --resume to start one",
                            folder.string()));
  const auto given = parse_csv(text).rows;
  const auto found = parse_csv(cli::read_text(path)).rows;
  const auto value_of = [](const auto& rows, const std::string& name) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.front() == name; });
    return row == rows.end() ? std::string("not given") : row->back();
  };
  const auto compare = [&](const auto& rows) {
    for (const auto& row : rows) {
      const std::string before = value_of(found, row.front()), now = value_of(given, row.front());
      if (before != now)
        throw Error(
            fmt::format("--resume: {} was {} in {} and is {} now; give the options of that folder, or "
                        "choose another folder with --output",
                        row.front(), before, folder.string(), now));
    }
  };
  compare(given);
  compare(found);
}

}  // namespace

bool run_table1(const Table1Options& options, const fs::path& folder, bool resume,
                const cli::Interruption& interruption, bool show_progress) {
  check_options(options, folder, resume);
  const auto run = [&](RunClock clock, double seconds, const char* name) {
    std::vector<Motion> motions;
    for (const Table1Scene& scene : options.scenes) {
      Motion& motion = motions.emplace_back(Motion{scene, {}, {}, seconds});
      for (const BoundingVolume volume : options.method.volumes)
        motion.variants.push_back({options.method, volume});
    }
    RunLog log(folder, name, resume);
    return run_all(motions,
                   {.clock = clock,
                    .runs = options.runs,
                    .seed = options.seed,
                    .exact = clock == RunClock::simulated,
                    .threads = options.threads},
                   log, interruption, show_progress);
  };
  if (options.simulated_seconds > 0 && !run(RunClock::simulated, options.simulated_seconds, "table1_runs"))
    return false;
  return !options.program_clock || run(RunClock::program, *options.program_clock, "table1_program_runs");
}

}  // namespace supple::experiments
