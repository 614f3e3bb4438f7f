#include "report.hpp"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "base/run_program.hpp"
#include "machine.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
namespace fs = std::filesystem;

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
    for (const Table& table : section.tables) text += '\n' + text_of(table);
  }
  if (!report.claims.empty()) text += "\nWhat holds\n";
  for (const Claim& claim : report.claims)
    text += fmt::format("- {}\n  {}{}\n", claim.text(), name_of(claim.verdict), claim.reason);
  return text;
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

void write_report(const Report& report, const fs::path& folder) {
  using Json = nlohmann::ordered_json;
  make_folder(folder);
  Json json{{"name", report.name}, {"title", report.title}, {"summary", report.summary}};
  for (const auto& [name, value] : report.parameters) json["parameters"][name] = value;
  for (const auto& [name, value] : describe_machine()) json["machine"][name] = value;
  json["claims"] = Json::array();
  Table claims{report.name + "_claims",
               "",
               {{"id", "Id"},
                {"where", "Where"},
                {"claim", "Claim"},
                {"verdict", "Verdict"},
                {"number", "Number"},
                {"error", "Standard error"},
                {"quantity", "Quantity"},
                {"reason", "Reason"}}};
  for (const Claim& claim : report.claims) {
    json["claims"].push_back(
        {{"paper", claim.text()}, {"verdict", name_of(claim.verdict)}, {"reason", claim.reason}});
    std::string verdict = name_of(claim.verdict);
    verdict.resize(verdict.size() - 2);  // without the full stop and the space
    const Estimate number = claim.number.value_or(estimate_of({}));
    claims.add({claim.id, claim.where, claim.paper, std::move(verdict), cell_of(number.mean),
                cell_of(number.error), claim.quantity, claim.reason});
  }
  if (!report.claims.empty()) write_file(folder / (claims.name + ".csv"), csv_head() + csv_of(claims));
  for (const Section& section : report.sections) {
    Json tables = Json::array();
    for (const Table& table : section.tables) {
      write_file(folder / (table.name + ".csv"),
                 (table.head.empty() ? csv_head() : table.head) + csv_of(table));
      Json columns = Json::array();
      for (const Column& column : table.columns)
        columns.push_back({{"heading", column.heading}, {"digits", column.digits}});
      tables.push_back({{"name", table.name}, {"caption", table.caption}, {"columns", std::move(columns)}});
    }
    json["sections"].push_back(
        {{"heading", section.heading}, {"paragraphs", section.paragraphs}, {"tables", std::move(tables)}});
  }
  write_file(folder / (report.name + "_report.json"),
             json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

int make_page(const fs::path& folder) {
  std::string python = "python3", argument = folder.string();
  std::string script =
      fs::read_symlink("/proc/self/exe").replace_filename("supple-experiment-report").string();
  char* const arguments[] = {python.data(), script.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, python.c_str(), nullptr, nullptr, arguments, environ) != 0)
    throw Error(
        "the report needs python3 with matplotlib, which is not there; install it, on Debian by: apt-get "
        "install python3-matplotlib; the tables are written");
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? cli::exit_done : cli::exit_unusable;
}

}  // namespace supple::experiments
