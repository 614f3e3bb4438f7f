#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "experiments/plot.hpp"
#include "experiments/table.hpp"

namespace supple::experiments {

/// What becomes of a sentence of the paper.
enum class Verdict { holds, does_not_hold, cannot_tell };

struct Claim {
  std::string paper;  ///< the claim, with the paper's section
  Verdict verdict = Verdict::cannot_tell;
  std::string reason;  ///< with the measured numbers
};

/// A paragraph, a table or a plot.
using Block = std::variant<std::string, Table, Plot>;

struct Section {
  std::string heading;
  std::vector<Block> blocks{};
};

/// Of one experiment.
struct Report {
  std::string name;  ///< of the files
  std::string title;
  std::string summary;
  std::vector<std::pair<std::string, std::string>> parameters{};
  std::vector<Claim> claims{};
  std::vector<Section> sections{};
};

/// A `reason` that begins with the verdict.
const char* name_of(Verdict verdict);
/// A number of words, `holds` when the condition does.
Verdict verdict_of(bool holds);

std::string text_of(const Report& report);
/// One page without external resources. `drawings` are those of the report's plots, in order; an empty one is
/// left out.
std::string html_of(const Report& report, const std::vector<std::string>& drawings);
/// Writes a CSV file of each table and the page into the folder, made when it is not there. Without gnuplot
/// the page has no plots; the message that says so is returned, else an empty one.
std::string write_report(const Report& report, const std::filesystem::path& folder);

}  // namespace supple::experiments
