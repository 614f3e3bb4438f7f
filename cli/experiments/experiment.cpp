#include "experiments/experiment.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "exit_status.hpp"
#include "experiments/arity.hpp"
#include "experiments/report.hpp"
#include "experiments/scaling.hpp"
#include "experiments/table1.hpp"

namespace supple::experiments {
namespace {

Report run(const ExperimentOptions& options) {
  if (options.kind == ExperimentOptions::Kind::table1) {
    Table1Options table1 = table1_options(options.quick);
    table1.runs = options.runs.value_or(table1.runs);
    table1.simulated_seconds = options.simulated_seconds.value_or(table1.simulated_seconds);
    if (options.wall_clock) table1.wall_clock = *options.wall_clock;
    table1.threads = options.threads.value_or(0);
    table1.seed = options.seed;
    return run_table1(table1, !options.quiet);
  }
  if (options.kind == ExperimentOptions::Kind::scaling) {
    ScalingOptions scaling = scaling_options(options.quick);
    scaling.threads = options.threads.value_or(1);
    scaling.seed = options.seed;
    return run_scaling(scaling, !options.quiet);
  }
  ArityOptions arity = arity_options(options.quick);
  arity.threads = options.threads.value_or(1);
  arity.seed = options.seed;
  return run_arity(arity, !options.quiet);
}

}  // namespace

const char* name_of(ExperimentOptions::Kind kind) {
  return kind == ExperimentOptions::Kind::table1    ? "table1"
         : kind == ExperimentOptions::Kind::scaling ? "scaling"
                                                    : "arity";
}

int run_experiment(const ExperimentOptions& options) {
  const std::filesystem::path folder =
      options.output.empty() ? fmt::format("experiment_{}", name_of(options.kind)) : options.output;
  const Report report = run(options);
  const std::string warning = write_report(report, folder);
  if (!options.quiet) {
    fmt::print("{}\n", text_of(report));
    fmt::print("Written: {}\n", (folder / (report.name + ".html")).string());
  }
  if (warning.empty()) return cli::exit_done;
  fmt::print(stderr, "supple: {}; the tables and the report without plots are written\n", warning);
  return cli::exit_unusable;
}

}  // namespace supple::experiments
