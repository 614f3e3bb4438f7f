#include "experiments/experiment_options.hpp"

#include <map>
#include <string>

namespace supple::experiments {
namespace {

constexpr const char* footer = R"(Examples:
  supple experiment table1 --quick
      A small version of the paper's Table 1: collisions of 3, 6 and 9 objects, with boxes and with spheres.
  supple experiment table1 --output table1
      Five runs of ten simulated minutes for each configuration. Writes CSV files and table1/table1.html.
  supple experiment table1 --wall-clock 600
      Also counts the collisions found in ten minutes of real time, as the paper does. Takes hours.
  supple experiment scaling
      Measures time against the number of objects, up to 1,000,000, and of vertices, and fits exponents.
  supple experiment arity
      Compares trees of two, four and eight children.

Each experiment writes CSV tables and a report as one HTML page into a folder, and reports which of the
paper's claims hold. Plots need the program gnuplot. Without it, everything else is written and the exit
status is 2. docs/experiments.md describes the experiments.)";

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
  app.add_option_function<std::string>("table1|scaling|arity", parse, "The experiment")
      ->required()
      ->type_name("");
}

}  // namespace

CLI::App* add_experiment(CLI::App& program, ExperimentOptions& options, cli::Dependences& dependences) {
  CLI::App* app = program.add_subcommand(
      "experiment", "Repeat the paper's experiments and report which of its claims hold");
  app->footer(footer);
  add_kind(*app, options);
  app->add_flag("--quick", options.quick, "Run a small version, in under a minute");
  app->add_option("--output", options.output, "Folder for the results (default: experiment_NAME)")
      ->type_name("DIR");
  cli::add_number(*app, "--threads", options.threads, 0, 1024,
                  "Worker threads; for table1, the number of parallel runs; 0 means one per core (default: 0 "
                  "for table1, otherwise 1)");
  cli::add_number(*app, "--seed", options.seed, 0, 1'000'000'000, "Seed of the random numbers (default: 1)");
  const auto table1_only = [&](CLI::Option* option) {
    dependences.push_back(
        {option, [&] { return options.kind == ExperimentOptions::Kind::table1; }, "table1"});
  };
  table1_only(
      cli::add_number(*app, "--wall-clock", options.wall_clock, 1, 1'000'000,
                      "table1: also count the collisions found in this many seconds of real time per run"));
  table1_only(cli::add_number(*app, "--runs", options.runs, 1, 1000,
                              "table1: number of runs per configuration (default: 5)"));
  table1_only(cli::add_number(*app, "--seconds", options.simulated_seconds, 1, 1'000'000,
                              "table1: simulated seconds per run (default: 600)"));
  app->add_flag("--quiet", options.quiet, "Print no tables and no progress");
  return app;
}

}  // namespace supple::experiments
