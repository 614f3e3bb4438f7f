#include "results.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <thread>

#include "base/files.hpp"
#include "base/run_program.hpp"
#include "supple/error.hpp"
#include "supple/utf8.hpp"
#include "supple/version.hpp"

namespace supple::experiments {
namespace fs = std::filesystem;
namespace {

#if defined(__clang__)
constexpr const char* compiler = "clang " __clang_version__;
#else
constexpr const char* compiler = "g++ " __VERSION__;
#endif
#ifdef NDEBUG
constexpr const char* build = "optimised";
#else
constexpr const char* build = "with assertions: times mean little";
#endif

std::string processor() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string command() {
  std::ifstream stream("/proc/self/cmdline");
  std::string text;
  std::getline(stream, text, '\0');  // the program
  text = "supple experiment";
  for (std::string word; std::getline(stream, word, '\0');) {
    if (word != "--resume" && word != "--quiet") text += ' ' + word;
  }
  return one_line(text);
}

std::string csv_field(const Cell& cell) {
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return fmt::format("{}", *count);
  if (const auto* number = std::get_if<double>(&cell))
    return std::isnan(*number) ? "" : fmt::format("{}", *number);
  const auto* text = std::get_if<std::string>(&cell);
  if (text == nullptr) return "";
  if (text->find_first_of(",\"\n\r#") == std::string::npos) return *text;
  std::string quoted = "\"";
  for (const char c : *text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns.size())
    throw Error(fmt::format("table {}: a row of {} cells for {} columns", name, row.size(), columns.size()));
  rows.push_back(std::move(row));
}

std::string csv_of(const Table& table) {
  std::string result = csv_of(std::vector<Cell>(table.columns.begin(), table.columns.end()));
  for (const auto& row : table.rows) result += csv_of(row);
  return result;
}

std::string csv_of(const std::vector<Cell>& row) {
  std::string result;
  for (std::size_t c = 0; c < row.size(); ++c) {
    if (c > 0) result += ',';
    result += csv_field(row[c]);
  }
  return result + '\n';
}

std::string csv_head() {
  return fmt::format(
      "# date: {:%Y-%m-%d}\n# commit: {}\n# processor: {}, {} cores\n# compiler: {}, {}\n# program: supple "
      "{}\n"
      "# command: {}\n",
      fmt::gmtime(std::time(nullptr)), commit(), processor(), std::thread::hardware_concurrency(), compiler,
      build, SUPPLE_VERSION, command());
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

void write_results(const Results& results, const fs::path& folder) {
  make_folder(folder);
  std::string head = csv_head();
  for (const auto& [name, value] : results.parameters)
    head += fmt::format("# {}: {}\n", name, one_line(value));
  for (const Table& table : results.tables) write_file(folder / (table.name + ".csv"), head + csv_of(table));
}

int judge(const fs::path& folder, bool quiet) {
  std::fflush(stdout);
  std::string python = "python3", argument = folder.string(), option = "--quiet";
  std::string script =
      fs::read_symlink("/proc/self/exe").replace_filename("supple-experiment-report").string();
  char* const arguments[] = {python.data(), script.data(), argument.data(), quiet ? option.data() : nullptr,
                             nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, python.c_str(), nullptr, nullptr, arguments, environ) != 0)
    throw Error(
        "the report needs python3 with matplotlib and scipy, which are not there; install them, on Debian "
        "by: apt-get install python3-matplotlib python3-scipy; the tables are written");
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? cli::exit_done : cli::exit_unusable;
}

}  // namespace supple::experiments
