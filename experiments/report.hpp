#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fit.hpp"
#include "table.hpp"

namespace supple::experiments {

/// The judgement of a claim of the paper.
enum class Verdict { holds, does_not_hold, cannot_tell };

struct Claim {
  std::string id;     ///< the name of the claim in documents: `test-cost`
  std::string where;  ///< the sections of the paper: `6, 7`; empty: a claim of our own
  std::string paper;  ///< the claim
  Verdict verdict = Verdict::cannot_tell;
  std::string reason{};  ///< with the measured numbers
  /// The number that decides and its standard error, and what it is, where there is one number.
  std::optional<Estimate> number{};
  std::string quantity{};

  /// The claim with its sections.
  std::string text() const { return where.empty() ? paper : paper + " (section " + where + ")"; }
};

/// The page has plots of some tables between the paragraphs and the tables.
struct Section {
  std::string heading;
  std::vector<std::string> paragraphs{};
  std::vector<Table> tables{};
};

/// The report of one experiment.
struct Report {
  std::string name;  ///< name of the files
  std::string title;
  std::string summary;
  std::vector<std::pair<std::string, std::string>> parameters{};
  std::vector<Claim> claims{};
  std::vector<Section> sections{};
};

/// The verdict in words, for the start of a reason.
const char* name_of(Verdict verdict);
/// The verdict `holds` when the condition is true, otherwise `does_not_hold`.
Verdict verdict_of(bool holds);

std::string text_of(const Report& report);
/// Creates a folder if necessary. Throws `Error` when that fails.
void make_folder(const std::filesystem::path& folder);
void write_file(const std::filesystem::path& path, const std::string& text);
/// Writes one CSV file per table, one for the claims (NAME_claims.csv), and everything else of the report as
/// JSON, into the folder, which is created if necessary.
void write_report(const Report& report, const std::filesystem::path& folder);
/// Makes the page of the files of a report: calls report.py, which is beside the program. Returns the exit
/// status of the program. Throws `Error` without Python.
int make_page(const std::filesystem::path& folder);

}  // namespace supple::experiments
