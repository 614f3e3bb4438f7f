#include <fmt/core.h>

#include <charconv>
#include <system_error>

#include "base/files.hpp"
#include "machine.hpp"
#include "supple/error.hpp"
#include "table1/table1_runs.hpp"

namespace supple::experiments {
namespace {

namespace fs = std::filesystem;

Table empty_table(RunClock clock) {
  Table table{name_of(clock) + "_runs",
              "Every run",
              {{"scene", "Scene"},
               {"edge", "Edge"},
               {"volume", "Volume"},
               {"seed", "Seed"},
               {"objects", "Objects"},
               {"broad", "Broad phase"},
               {"narrow", "Narrow phase"}}};
  const auto add = [&](const char* name, const char* heading) {
    table.columns.push_back({name, heading, 4});
  };
  if (clock == RunClock::simulated) add("exact", "Exact");
  add("steps", "Steps");
  add("detection_seconds", "Detection, s");
  add("motion_seconds", "Motion, s");
  add("mean_strain", "Mean strain");
  add("least_strain", "Least mean");
  add("most_strain", "Greatest mean");
  add("largest_strain", "Largest strain of an edge");
  add("failure", "Broke off");
  return table;
}

std::vector<Cell> row_of(const Runs& runs, std::uint64_t seed, const RunCounts& run, RunClock clock) {
  std::vector<Cell> row{runs.scene.name,
                        runs.edge ? Cell(*runs.edge) : Cell(),
                        std::string(word_of(runs.volume)),
                        seed,
                        runs.objects,
                        run.broad,
                        run.narrow};
  if (clock == RunClock::simulated) row.emplace_back(run.exact);
  row.emplace_back(run.steps);
  row.insert(row.end(), {run.detection_seconds, run.motion_seconds, run.strain.mean, run.strain.least,
                         run.strain.most, run.strain.largest});
  row.push_back(run.failure.empty() ? Cell() : Cell(run.failure));
  return row;
}

/// The number in the field at `place`, which then moves on; false when there is none.
template <class Number>
bool read(const std::vector<std::string>& fields, std::size_t& place, Number& number) {
  const std::string& text = fields[place++];
  const char* const end = text.data() + text.size();
  const auto [parsed, fault] = std::from_chars(text.data(), end, number);
  return fault == std::errc{} && parsed == end;
}

/// The counts in a row of the file; false when a field is not a number.
bool read(const std::vector<std::string>& fields, RunClock clock, RunCounts& run) {
  std::size_t place = 5;
  run.failure = fields.back();
  const auto read_all = [&](auto&... numbers) { return (read(fields, place, numbers) && ...); };
  return read_all(run.broad, run.narrow) && (clock == RunClock::program || read_all(run.exact)) &&
         read_all(run.steps, run.detection_seconds, run.motion_seconds, run.strain.mean, run.strain.least,
                  run.strain.most, run.strain.largest);
}

std::string key_of(const std::vector<std::string>& fields) {
  return fmt::format("{}\n{}\n{}\n{}", fields[0], fields[1], fields[2], fields[3]);
}

std::vector<std::string> fields_of(const std::vector<Cell>& row) {
  return parse_csv(csv_of(row)).rows.front();
}

}  // namespace

std::string name_of(RunClock clock) {
  return clock == RunClock::program ? "table1_program" : "table1";
}

Table runs_table(const std::vector<Runs>& all, std::uint64_t first_seed, RunClock clock) {
  Table table = empty_table(clock);
  for (const Runs& runs : all) {
    for (std::size_t i = 0; i < runs.counts.size(); ++i)
      table.add(row_of(runs, first_seed + i, runs.counts[i], clock));
  }
  return table;
}

RunLog::RunLog(const fs::path& folder, RunClock clock, bool resume) : clock_(clock) {
  const Table table = empty_table(clock);
  const fs::path path = folder / (table.name + ".csv");
  const std::string header = csv_head() + csv_of(table);
  std::size_t length = 0;
  if (resume && fs::exists(path)) {
    const std::string text = cli::read_text(path);
    const CsvText csv = parse_csv(text);
    if (!csv.rows.empty() && csv.rows.front() != parse_csv(header).rows.front())
      throw Error(
          fmt::format("{}: has other columns than this program writes; leave out --resume to start "
                      "again",
                      path.string()));
    for (std::size_t i = 1; i < csv.rows.size(); ++i) {
      RunCounts run;
      if (csv.rows[i].size() != table.columns.size() || !read(csv.rows[i], clock, run))
        throw Error(fmt::format("{}: row {} is not a run; remove it, or leave out --resume to start again",
                                path.string(), i));
      done_[key_of(csv.rows[i])] = run;
    }
    length = csv.length;
    // A program that was killed leaves an incomplete line behind.
    if (length < text.size()) fs::resize_file(path, length);
  }
  file_.emplace(path.string(), length > 0 ? cli::OutputFile::Mode::append : cli::OutputFile::Mode::replace);
  if (length == 0) std::fwrite(header.data(), 1, header.size(), file_->stream());
  std::fflush(file_->stream());
  file_->check();
}

const RunCounts* RunLog::find(const Runs& runs, std::uint64_t seed) const {
  const auto found = done_.find(key_of(fields_of(row_of(runs, seed, {}, clock_))));
  return found == done_.end() ? nullptr : &found->second;
}

void RunLog::add(const Runs& runs, std::uint64_t seed, const RunCounts& counts) {
  const std::string line = csv_of(row_of(runs, seed, counts, clock_));
  std::fwrite(line.data(), 1, line.size(), file_->stream());
  std::fflush(file_->stream());
  file_->check();
}

}  // namespace supple::experiments
