#include <string_view>

#include "base/run_program.hpp"
#include "base/text.hpp"
#include "commands/commands.hpp"

namespace supple::cli {
namespace {

int run(const CommandLine& line) {
  Ranks one;
  switch (line.command) {
    case CommandLine::Command::detect:
      return run_detect(line.detect, one);
    case CommandLine::Command::simulate:
      return run_simulate(line.simulate, one);
    case CommandLine::Command::view:
      return run_view(line.view);
    case CommandLine::Command::render:
      return run_render(line.render);
    case CommandLine::Command::info:
      return run_info(line.info);
    case CommandLine::Command::query:
      return run_query(line.query);
    case CommandLine::Command::ccd_queries:
      return run_ccd_queries(line.ccd_queries);
    case CommandLine::Command::diff:
      return run_diff(line.diff);
    case CommandLine::Command::experiment:  // another program
    case CommandLine::Command::exit:
      break;
  }
  return line.exit_status;
}

/// Continues as the program of experiments. Throws `Error` when there is none.
[[noreturn]] void run_experiments(char** arguments) {
  become_program("supple-experiment", arguments);
  fail(
      "the program supple-experiment is neither beside this program nor in PATH; build it by: cmake --build "
      "--preset release --target supple_experiment");
}

}  // namespace
}  // namespace supple::cli

int main(int argument_count, char** arguments) {
  using namespace supple::cli;
  return run_program([&] {
    const std::string_view first = argument_count > 1 ? arguments[1] : "";
    if (first == "experiment") run_experiments(arguments + 1);
    // The Python package starts experiments and `view --export` from ranks of its own.
    if (const LaunchedProcess process = launched_process(); process.size > 1 && first != "view")
      run_as_rank(process, arguments);
    // The documents describe the options of all commands, also those of experiments.
    if (first == "--describe") run_experiments(arguments);
    return run(parse_command_line(argument_count, arguments));
  });
}
