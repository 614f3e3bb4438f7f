#include "report.hpp"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <span>

#include "exit_status.hpp"
#include "json_writer.hpp"
#include "machine.hpp"
#include "output_file.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
namespace {

namespace fs = std::filesystem;

void write_pairs(cli::JsonWriter& json, const char* name,
                 const std::vector<std::pair<std::string, std::string>>& pairs) {
  json.key(name);
  json.begin_object();
  for (const auto& [key, value] : pairs) json.member(key.c_str(), value);
  json.end_object();
}

void write_claims(cli::JsonWriter& json, const std::vector<Claim>& claims) {
  json.key("claims");
  json.begin_array();
  for (const Claim& claim : claims) {
    json.begin_object();
    json.member("paper", claim.paper);
    json.member("verdict", name_of(claim.verdict));
    json.member("reason", claim.reason);
    json.end_object();
  }
  json.end_array();
}

void write_table(cli::JsonWriter& json, const Table& table) {
  json.begin_object();
  json.member("name", table.name);
  json.member("caption", table.caption);
  json.key("columns");
  json.begin_array();
  for (const Column& column : table.columns) {
    json.begin_object();
    json.member("heading", column.heading);
    json.member("digits", static_cast<std::uint32_t>(column.digits));
    json.end_object();
  }
  json.end_array();
  json.end_object();
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
    for (const Table& table : section.tables) text += '\n' + text_of(table);
  }
  if (!report.claims.empty()) text += "\nWhat holds\n";
  for (const Claim& claim : report.claims)
    text += fmt::format("- {}\n  {}{}\n", claim.paper, name_of(claim.verdict), claim.reason);
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
  make_folder(folder);
  cli::JsonWriter json((folder / (report.name + "_report.json")).string());
  json.begin_object();
  json.member("name", report.name);
  json.member("title", report.title);
  json.member("summary", report.summary);
  write_pairs(json, "parameters", report.parameters);
  write_pairs(json, "machine", describe_machine());
  write_claims(json, report.claims);
  json.key("sections");
  json.begin_array();
  for (const Section& section : report.sections) {
    json.begin_object();
    json.member("heading", section.heading);
    json.key("paragraphs");
    json.value(std::span(section.paragraphs));
    json.key("tables");
    json.begin_array();
    for (const Table& table : section.tables) {
      write_file(folder / (table.name + ".csv"), csv_head() + csv_of(table));
      write_table(json, table);
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.close();
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
