#include <string_view>
#include <vector>

#include "base/run_program.hpp"
#include "experiment.hpp"
#include "options/options.hpp"

int main(int argument_count, char** argument_values) {
  using namespace supple;
  std::vector<const char*> arguments(argument_values, argument_values + argument_count);
  // `supple-experiment NAME` is `supple experiment NAME`; `--describe` belongs to the whole program.
  if (argument_count < 2 || arguments[1] != std::string_view("--describe"))
    arguments.insert(arguments.begin() + 1, "experiment");
  return cli::run_program([&] {
    experiments::ExperimentOptions options;
    const cli::CommandLine line =
        cli::parse_command_line(static_cast<int>(arguments.size()), arguments.data(),
                                [&](CLI::App& app, cli::Dependences& dependences) {
                                  experiments::add_options(app, options, dependences);
                                });
    return line.command == cli::CommandLine::Command::experiment ? experiments::run_experiment(options)
                                                                 : line.exit_status;
  });
}
