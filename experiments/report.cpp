#include "report.hpp"

#include <fmt/core.h>

#include <cstddef>

#include "html.hpp"
#include "machine.hpp"
#include "output_file.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* style = R"(
:root { color-scheme: light dark; --text: #1b1b1b; --page: #ffffff; --soft: #f1f3f5; --line: #c9ced3;
  --holds: #0b6e3a; --fails: #b3261e; --open: #7a5b00; }
@media (prefers-color-scheme: dark) { :root { --text: #e6e6e6; --page: #16181b; --soft: #23272c; --line: #474d54;
  --holds: #5fd08f; --fails: #ff8a80; --open: #e6c15a; } }
body { margin: 2rem auto; max-width: 64rem; padding: 0 1rem; background: var(--page); color: var(--text);
  font: 16px/1.5 sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; } h2 { font-size: 1.25rem; margin-top: 2.2rem; }
.table { overflow-x: auto; margin: 1.2rem 0; }
table { border-collapse: collapse; font-size: 0.9rem; }
caption { text-align: left; font-weight: bold; padding-bottom: 0.4rem; }
th, td { padding: 0.25rem 0.8rem 0.25rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
th { border-bottom-width: 2px; vertical-align: bottom; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.claim { background: var(--soft); border-left: 5px solid; padding: 0.6rem 1rem; margin: 0.8rem 0; }
.claim p { margin: 0.15rem 0; } .claim b { text-transform: uppercase; font-size: 0.8rem; letter-spacing: 0.04em; }
.holds { border-color: var(--holds); } .holds b { color: var(--holds); }
.fails { border-color: var(--fails); } .fails b { color: var(--fails); }
.open { border-color: var(--open); } .open b { color: var(--open); }
svg { width: 100%; height: auto; color: var(--text); margin: 0.8rem 0; }
)";

const char* class_of(Verdict verdict) {
  return verdict == Verdict::holds           ? "claim holds"
         : verdict == Verdict::does_not_hold ? "claim fails"
                                             : "claim open";
}

void write_claims(Html& html, const std::vector<Claim>& claims) {
  if (claims.empty()) return;
  html.element("h2", "What holds");
  for (const Claim& claim : claims) {
    html.open("div", {{"class", class_of(claim.verdict)}});
    html.element("p", claim.paper);
    html.open("p");
    html.element("b", name_of(claim.verdict));
    html.text(claim.reason);
    html.close();
    html.close();
  }
}

void write_parameters(Html& html, const Report& report) {
  html.element("h2", "Parameters and machine");
  html.open("div", {{"class", "table"}});
  html.open("table");
  html.open("tbody");
  const auto rows = [&](const std::vector<std::pair<std::string, std::string>>& entries) {
    for (const auto& [name, value] : entries) {
      html.open("tr");
      html.element("td", name);
      html.element("td", value);
      html.close();
    }
  };
  rows(report.parameters);
  rows(describe_machine());
  html.close();
  html.close();
  html.close();
}

/// Draws the plots of the report. Without gnuplot, all drawings are empty and the result has the reason.
std::string draw(const Report& report, std::vector<std::string>& drawings) {
  std::string missing;
  for (const Section& section : report.sections) {
    for (const Block& block : section.blocks) {
      const Plot* plot = std::get_if<Plot>(&block);
      if (plot == nullptr) continue;
      drawings.emplace_back();
      if (!missing.empty()) continue;
      try {
        drawings.back() = svg_of(*plot, static_cast<int>(drawings.size()));
      } catch (const GnuplotMissing& error) {
        missing = error.what();
      }
    }
  }
  return missing;
}

}  // namespace

const char* name_of(Verdict verdict) {
  return verdict == Verdict::holds           ? "Holds. "
         : verdict == Verdict::does_not_hold ? "Does not hold. "
                                             : "Undecided. ";
}

Verdict verdict_of(bool holds) {
  return holds ? Verdict::holds : Verdict::does_not_hold;
}

std::string text_of(const Report& report) {
  std::string text = fmt::format("{}\n\n{}\n", report.title, report.summary);
  for (const Section& section : report.sections) {
    for (const Block& block : section.blocks) {
      if (const Table* table = std::get_if<Table>(&block)) text += '\n' + text_of(*table);
    }
  }
  if (!report.claims.empty()) text += "\nWhat holds\n";
  for (const Claim& claim : report.claims)
    text += fmt::format("- {}\n  {}{}\n", claim.paper, name_of(claim.verdict), claim.reason);
  return text;
}

std::string html_of(const Report& report, const std::vector<std::string>& drawings) {
  Html html;
  html.raw("<!DOCTYPE html>\n");
  html.open("html", {{"lang", "en"}});
  html.open("head");
  html.empty_element("meta", {{"charset", "utf-8"}});
  html.empty_element("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.element("title", report.title);
  html.open("style");
  html.raw(style);
  html.close();
  html.close();
  html.open("body");
  html.element("h1", report.title);
  html.element("p", report.summary);
  write_claims(html, report.claims);
  std::size_t next_drawing = 0;
  for (const Section& section : report.sections) {
    html.element("h2", section.heading);
    for (const Block& block : section.blocks) {
      if (const auto* paragraph = std::get_if<std::string>(&block)) html.element("p", *paragraph);
      if (const auto* table = std::get_if<Table>(&block)) html.raw(html_of(*table));
      if (std::holds_alternative<Plot>(block) && next_drawing < drawings.size())
        html.raw(drawings[next_drawing++]);
    }
  }
  write_parameters(html, report);
  return html.finish();
}

void make_folder(const fs::path& folder) {
  std::error_code fault;
  fs::create_directories(folder, fault);
  if (!fs::is_directory(folder))
    throw Error(fmt::format("{}: cannot make this folder: {}; choose another with --output", folder.string(),
                            fault.message()));
}

void write_file(const fs::path& path, const std::string& text) {
  cli::OutputFile file(path.string());
  std::fwrite(text.data(), 1, text.size(), file.stream());
  file.close();
}

std::string write_report(const Report& report, const fs::path& folder) {
  make_folder(folder);
  for (const Section& section : report.sections) {
    for (const Block& block : section.blocks) {
      if (const auto* table = std::get_if<Table>(&block))
        write_file(folder / (table->name + ".csv"), csv_of(*table));
    }
  }
  std::vector<std::string> drawings;
  const std::string missing = draw(report, drawings);
  write_file(folder / (report.name + ".html"), html_of(report, drawings));
  return missing;
}

}  // namespace supple::experiments
