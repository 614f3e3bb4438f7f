#include "experiment.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <string>
#include <utility>

#include "base/interruption.hpp"
#include "base/run_program.hpp"
#include "program_2007/program_2007.hpp"
#include "results.hpp"
#include "studies/studies.hpp"
#include "supple/utf8.hpp"
#include "table1/table1.hpp"

namespace supple::experiments {
namespace {

using Kind = ExperimentOptions::Kind;

Table1Options table1_options(const ExperimentOptions& options) {
  Table1Options table1 = default_table1_options(options.quick);
  if (!options.objects.empty() || !options.scenes.empty()) table1.scenes.clear();
  for (const std::uint32_t objects : options.objects) table1.scenes.push_back(mixed_scene(objects));
  for (const std::string& scene : options.scenes) table1.scenes.push_back(scene_called(scene));
  if (!options.scene_sizes.empty()) {
    std::vector<Table1Scene> resized;
    for (const Table1Scene& scene : table1.scenes) {
      for (const double size : options.scene_sizes) {
        if (!scene.size) resized.emplace_back(scene).size = size;
      }
    }
    table1.scenes = std::move(resized);
  }
  table1.method = options.method;
  table1.runs = options.runs.value_or(table1.runs);
  table1.simulated_seconds = options.simulated_seconds.value_or(table1.simulated_seconds);
  if (options.program_clock) table1.program_clock = *options.program_clock;
  table1.threads = options.threads;
  table1.seed = options.seed;
  return table1;
}

/// Runs an experiment that cannot be resumed.
Results run(const ExperimentOptions& given, const std::filesystem::path& folder) {
  const bool shown = !given.quiet;
  const auto with_seed = [&](auto options) {
    options.seed = given.seed;
    return options;
  };
  switch (given.kind) {
    case Kind::scaling:
      return run_scaling(scaling_options(given.quick, given.seed), shown);
    case Kind::volumes:
      return run_volumes(with_seed(volumes_options(given.quick)), shown);
    case Kind::claims:
      return run_claims(with_seed(claims_options(given.quick)), shown);
    case Kind::ablation:
      return run_ablation(with_seed(ablation_options(given.quick)), shown);
    case Kind::trials:
      return run_trials(with_seed(trial_options(given.quick)), shown);
    case Kind::figures:
      return run_figures(with_seed(figures_options(given.quick)), folder, shown);
    default:
      return run_arity(with_seed(arity_options(given.quick)), shown);
  }
}

}  // namespace

const std::string& name_of(Kind kind) {
  return experiment_names[static_cast<std::size_t>(kind)];
}

int run_experiment(const ExperimentOptions& options) {
  const std::filesystem::path folder =
      options.output.empty() ? "experiment_" + name_of(options.kind) : options.output;
  if (options.kind == Kind::table1 || options.kind == Kind::sensitivity) {
    const cli::Interruption interruption;
    const Table1Options table1 = table1_options(options);
    const bool is_complete =
        options.kind == Kind::table1
            ? run_table1(table1, folder, options.resume, interruption, !options.quiet)
            : run_sensitivity(table1, options.quick, folder, options.resume, interruption, !options.quiet);
    if (!is_complete) {
      fmt::print(
          stderr,
          "supple: interrupted; {} has the complete runs, and the same command with --resume goes on\n",
          one_line(folder.string()));
      return cli::exit_interrupted + interruption.signal();
    }
  } else {
    write_results(run(options, folder), folder);
  }
  return judge(folder, options.quiet);
}

}  // namespace supple::experiments
