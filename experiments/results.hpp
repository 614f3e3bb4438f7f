#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "table.hpp"

namespace supple::experiments {

/// What one experiment measured. It judges nothing: the script `supple-experiment-report` does, from the
/// files.
struct Results {
  std::string name;
  std::vector<std::pair<std::string, std::string>> parameters{};  ///< also in the head of each file
  std::vector<Table> tables{};
};

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
