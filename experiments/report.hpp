#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "plot.hpp"
#include "table.hpp"

namespace supple::experiments {

/// The judgement of a claim of the paper.
enum class Verdict { holds, does_not_hold, cannot_tell };

struct Claim {
  std::string paper;  ///< the claim and its section of the paper
  Verdict verdict = Verdict::cannot_tell;
  std::string reason;  ///< with the measured numbers
};

/// A paragraph, a table or a plot.
using Block = std::variant<std::string, Table, Plot>;

struct Section {
  std::string heading;
  std::vector<Block> blocks{};
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
/// Makes one page without external resources. `drawings` are the plots of the report, in order; empty
/// drawings are left out.
std::string html_of(const Report& report, const std::vector<std::string>& drawings);
/// Creates a folder if necessary. Throws `Error` when that fails.
void make_folder(const std::filesystem::path& folder);
void write_file(const std::filesystem::path& path, const std::string& text);
/// Writes one CSV file per table and the page into the folder, which is created if necessary. Without
/// gnuplot, the page has no plots and the function returns a message; otherwise it returns an empty text.
std::string write_report(const Report& report, const std::filesystem::path& folder);

}  // namespace supple::experiments
