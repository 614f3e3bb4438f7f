#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace supple::experiments {

/// The value of a cell: nothing, a word, a count or a measured number.
using Cell = std::variant<std::monostate, std::string, std::uint64_t, double>;

/// What an experiment measured, one row for each run or round.
struct Table {
  std::string name;                  ///< of the CSV file, without its ending
  std::vector<std::string> columns;  ///< lower_case, with the unit
  std::vector<std::vector<Cell>> rows{};

  /// Throws `Error` unless there is a cell for each column.
  void add(std::vector<Cell> row);
};

/// CSV as in RFC 4180, with line feeds, and quotes around texts with #, which begins a comment. Measured
/// numbers have enough digits to read back the same number; one that is not a number is an empty field.
std::string csv_of(const Table& table);
/// One line of CSV with its line feed.
std::string csv_of(const std::vector<Cell>& row);

/// How an experiment runs.
struct Request {
  bool quick = false;  ///< a small version, in under a minute
  std::uint64_t seed = 1;
  std::filesystem::path folder{};  ///< for the log of runs
  bool show_progress = false;
};

/// What an experiment measured. It judges nothing: the script `supple-experiment-report` does, from the
/// files.
struct Results {
  std::vector<Table> tables{};
  std::vector<std::pair<std::string, std::string>> parameters{};  ///< in the head of each file
};

/// The commit of the sources, `-dirty` after it if files differ from it; `unknown` without git.
const char* commit();
/// The things on which results depend, as comments at the start of a CSV file: date, commit, processor,
/// compiler, command without what changes no number.
std::string csv_head();

/// Creates a folder if necessary. Throws `Error` when that fails.
void make_folder(const std::filesystem::path& folder);
void write_file(const std::filesystem::path& path, const std::string& text);
/// One CSV file for each table, into the folder, which is created if necessary.
void write_results(const Results& results, const std::filesystem::path& folder);
/// Judges the claims and makes the page from the files of a folder: calls supple-experiment-report, which is
/// beside the program; prints the verdicts unless `quiet`. Returns the exit status of the program. Throws
/// `Error` without Python.
int judge(const std::filesystem::path& folder, bool quiet);

}  // namespace supple::experiments
