#include "table1/table1.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/files.hpp"
#include "machine.hpp"
#include "supple/error.hpp"
#include "table1/paper_table.hpp"
#include "table1/table1_claims.hpp"
#include "table1/table1_clocks.hpp"
#include "table1/table1_runs.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

namespace fs = std::filesystem;

/// The paper's row for a scene, if the paper has numbers for it.
const PaperRow* paper_row_of(const Runs& runs) {
  return is_of_table(runs) ? paper_row(runs.scene.objects, runs.volume) : nullptr;
}

/// A phase: its name, its number in a run, and its numbers in the paper.
struct Phase {
  const char* name;
  std::uint64_t RunCounts::*member;
  std::array<double, 5> PaperRow::*paper;  ///< null: the paper has no such phase
};
constexpr Phase phases[] = {{"broad", &RunCounts::broad, &PaperRow::broad},
                            {"narrow", &RunCounts::narrow, &PaperRow::narrow},
                            {"exact", &RunCounts::exact, nullptr}};

Table means_table(const std::vector<Runs>& all, RunClock clock) {
  Table table{name_of(clock) + "_means",
              fmt::format("Averages over the runs of {} s, and those of the paper's runs of 600 s",
                          all.front().run_seconds),
              {{"scene", "Scene"},
               {"edge", "Edge"},
               {"volume", "Volume"},
               {"phase", "Phase"},
               {"mean", "Mean"},
               {"error", "± error", 2},
               {"seconds", "Seconds per collision"},
               {"paper_mean", "Paper: mean"},
               {"paper_error", "± error", 2},
               {"paper_seconds", "Seconds per collision"}}};
  for (const Runs& runs : all) {
    for (const Phase& phase : phases) {
      if (clock != RunClock::simulated && phase.paper == nullptr) continue;
      const Estimate ours = runs.estimate(phase.member);
      std::vector<Cell> row{runs.scene.name,
                            runs.edge ? Cell(*runs.edge) : Cell(),
                            std::string(word_of(runs.volume)),
                            std::string(phase.name),
                            ours.mean,
                            cell_of(ours.error),
                            runs.seconds_for_one(phase.member)};
      if (const PaperRow* const paper = paper_row_of(runs); paper != nullptr && phase.paper != nullptr) {
        const Estimate theirs = estimate_of(paper->*phase.paper);
        row.insert(row.end(), {theirs.mean, theirs.error, seconds_per_collision(paper->*phase.paper)});
      }
      row.resize(table.columns.size());
      table.add(std::move(row));
    }
  }
  return table;
}

Section section_of(const std::string& heading, const std::string& paragraph, const std::vector<Runs>& all,
                   std::uint64_t first_seed, RunClock clock, const fs::path& folder) {
  Table runs = runs_table(all, first_seed, clock);
  runs.head =
      head_of(cli::read_text(folder / (runs.name + ".csv")));  // --resume may complete an earlier program
  return {heading, {paragraph}, {means_table(all, clock), std::move(runs)}};
}

std::string paragraph_of_program(const std::vector<Runs>& program) {
  double detection = 0, motion = 0;
  for (const Runs& runs : program) {
    for (const RunCounts& run : runs.counts) {
      detection += run.detection_seconds;
      motion += run.motion_seconds;
    }
  }
  return fmt::format(
      "The clock counts the detection and the motion, which took {:.0f} % of it. The paper does not say "
      "whether "
      "its ten minutes contain the motion; its program had no clock of its own for the detection. Numbers "
      "depend on the machine and on its load.",
      100 * motion / (detection + motion));
}

/// How much bodies bend in the runs.
std::string paragraph_of_strain(const std::vector<Runs>& all) {
  double mean = 0, count = 0, least = std::numeric_limits<double>::infinity(), most = 0, largest = 0;
  for (const Runs& runs : all) {
    for (const RunCounts& run : runs.counts) {
      mean += run.strain.mean;
      ++count;
      least = std::min(least, run.strain.least);
      most = std::max(most, run.strain.most);
      largest = std::max(largest, run.strain.largest);
    }
  }
  return fmt::format(
      "Bodies bend until the end: the mean strain of their edges is {:.1f} % over all runs, in each sample "
      "after "
      "the first second from {:.1f} to {:.1f} %, and that of a single edge at most {:.1f} %.",
      100 * mean / count, 100 * least, 100 * most, 100 * largest);
}

constexpr const char* options_file = "table1_options.csv";

/// Writes the options into the folder, which is created if necessary; or with `resume` compares them with
/// those of the folder.
void check_options(const Table1Options& options, const fs::path& folder, bool resume) {
  const fs::path path = folder / options_file;
  Table table{"table1_options", "", {{"option", "Option"}, {"value", "Value"}}};
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

std::optional<Report> run_table1(const Table1Options& options, const fs::path& folder, bool resume,
                                 const cli::Interruption& interruption, bool show_progress) {
  check_options(options, folder, resume);
  std::vector<Runs> steps, program;
  if (options.simulated_seconds > 0) {
    RunLog log(folder, RunClock::simulated, resume);
    auto runs = run_by_steps(options, log, interruption, show_progress);
    if (!runs) return std::nullopt;
    steps = std::move(*runs);
  }
  if (options.program_clock) {
    RunLog log(folder, RunClock::program, resume);
    auto runs = run_by_clock(options, log, interruption, show_progress);
    if (!runs) return std::nullopt;
    program = std::move(*runs);
  }

  Report report;
  report.name = "table1";
  report.title = "The paper's Table 1: collisions of moving objects";
  report.summary =
      "A collision is counted when a pair of objects begins to collide: in the broad phase when their "
      "volumes "
      "begin to overlap; in the narrow phase, as in the paper, when leaves of both octrees begin to overlap; "
      "and exactly when triangles begin to intersect. The scenes table1_3, table1_6, … have pawns, fish and "
      "rabbits of masses and springs in a cube whose border reflects them.";
  report.parameters = describe(options);
  report.claims = judge_table1(steps, program);
  report.sections.push_back(
      {"Three clocks side by side",
       {"The same objects count differently by each clock: in simulated time the volumes alone decide; by "
        "the "
        "clock of the detection, boxes take more steps; by the clock of the whole program, the motion hides "
        "a "
        "part of that. Each run has its collisions, the seconds of its detection without the exact stage and "
        "those of its motion, so one run counts by all clocks. Both volumes see the same motion, step by "
        "step."},
       {clocks_table(steps, program), rates_table(steps, program)}});
  if (!steps.empty())
    report.sections.push_back(section_of(
        "Counted in simulated time",
        "The same seeds give the same motion with all volumes. The paper does not give the size of "
        "its scene and the speed of its objects. So compare rows with each other, not single "
        "numbers with those of the paper. Its runs took ten minutes of real time. " +
            paragraph_of_strain(steps),
        steps, options.seed, RunClock::simulated, folder));
  if (!program.empty())
    report.sections.push_back(section_of("Counted by the clock of the whole program",
                                         paragraph_of_program(program) + ' ' + paragraph_of_strain(program),
                                         program, options.seed, RunClock::program, folder));
  report.sections.push_back({"The paper's own numbers", {}, {paper_arithmetic()}});
  return report;
}

}  // namespace supple::experiments
