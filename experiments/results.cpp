#include "results.hpp"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/files.hpp"
#include "base/run_program.hpp"
#include "machine.hpp"
#include "supple/error.hpp"
#include "supple/utf8.hpp"

namespace supple::experiments {
namespace fs = std::filesystem;

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
        "by: "
        "apt-get install python3-matplotlib python3-scipy; the tables are written");
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? cli::exit_done : cli::exit_unusable;
}

}  // namespace supple::experiments
