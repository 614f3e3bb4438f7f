#include "experiments/experiment_options.hpp"

#include <map>
#include <string>

namespace supple::experiments {
namespace {

constexpr const char* footer = R"(Examples:
  supple experiment table1 --quick
      The paper's Table 1 in small: collisions of 3, 6 and 9 objects, boxes and spheres, in under a minute.
  supple experiment table1 --output table1
      Ten simulated minutes a run, five runs each, as CSV files and table1/table1.html.
  supple experiment table1 --wall-clock 600
      Also as the paper did: what is found in ten minutes by the clock. Takes hours.
  supple experiment scaling
      Time against the number of objects, up to 1,000,000, and of vertices, with fitted exponents.
  supple experiment arity
      Trees of two, four and eight children.

Each writes tables as CSV and a report as one HTML page into a folder, and says which of the paper's claims hold. Plots
need the program gnuplot; without it everything else is written, and the exit status is 2. docs/experiments.md describes
them.)";

void add_kind(CLI::App& app, ExperimentOptions& options) {
  using Kind = ExperimentOptions::Kind;
  const std::map<std::string, Kind> kinds{
      {"table1", Kind::table1}, {"scaling", Kind::scaling}, {"arity", Kind::arity}};
  const auto parse = [&options, kinds](const std::string& given) {
    const auto found = kinds.find(given);
    if (found == kinds.end())
      throw CLI::ValidationError("experiment",
                                 "there is no experiment '" + given + "'; choose table1, scaling or arity");
    options.kind = found->second;
  };
  app.add_option_function<std::string>("table1|scaling|arity", parse, "Which experiment")
      ->required()
      ->type_name("");
}

}  // namespace

CLI::App* add_experiment(CLI::App& program, ExperimentOptions& options, cli::Dependences& dependences) {
  CLI::App* app = program.add_subcommand("experiment",
                                         "Repeat the paper's experiments, and say which of its claims hold");
  app->footer(footer);
  add_kind(*app, options);
  app->add_flag("--quick", options.quick, "A small version, in under a minute");
  app->add_option("--output", options.output, "Folder to write to (default: experiment_ and the name)")
      ->type_name("DIR");
  cli::add_number(
      *app, "--threads", options.threads, 0, 1024,
      "Worker threads, of table1 runs at a time; 0 for one a core (default: 0 for table1, 1 for the others)");
  cli::add_number(*app, "--seed", options.seed, 0, 1'000'000'000, "Of the random numbers (default: 1)");
  const auto table1_only = [&](CLI::Option* option) {
    dependences.push_back(
        {option, [&] { return options.kind == ExperimentOptions::Kind::table1; }, "table1"});
  };
  table1_only(cli::add_number(*app, "--wall-clock", options.wall_clock, 1, 1'000'000,
                              "Of table1, also count what is found in so many seconds by the clock a run"));
  table1_only(
      cli::add_number(*app, "--runs", options.runs, 1, 1000, "Of table1, runs of each kind (default: 5)"));
  table1_only(cli::add_number(*app, "--seconds", options.simulated_seconds, 1, 1'000'000,
                              "Of table1, simulated seconds a run (default: 600)"));
  app->add_flag("--quiet", options.quiet, "No tables and no progress");
  return app;
}

}  // namespace supple::experiments
