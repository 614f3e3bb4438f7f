#include "experiment.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "base/interruption.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "program_2007/ablation.hpp"
#include "program_2007/figures.hpp"
#include "program_2007/sensitivity.hpp"
#include "program_2007/trials.hpp"
#include "report.hpp"
#include "studies/arity.hpp"
#include "studies/claims.hpp"
#include "studies/scaling.hpp"
#include "studies/volumes.hpp"
#include "table1/table1.hpp"
#include "table1/table1_scenes.hpp"

namespace supple::experiments {
namespace {

Table1Options table1_options(const ExperimentOptions& options) {
  Table1Options table1 = default_table1_options(options.quick);
  if (!options.objects.empty() || !options.scenes.empty()) table1.scenes.clear();
  for (const std::uint32_t objects : options.objects) table1.scenes.push_back(mixed_scene(objects));
  for (const std::string& scene : options.scenes) {
    const auto source = is_built_in(scene) ? Table1Scene::Source::built_in : Table1Scene::Source::file;
    table1.scenes.push_back({source, scene});
  }
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

/// Runs an experiment other than table1.
Report run(const ExperimentOptions& options, const std::filesystem::path& folder) {
  if (options.kind == ExperimentOptions::Kind::scaling) {
    ScalingOptions scaling = scaling_options(options.quick);
    scaling.threads = options.threads.value_or(1);
    scaling.seed = options.seed;
    return run_scaling(scaling, !options.quiet);
  }
  if (options.kind == ExperimentOptions::Kind::volumes) {
    VolumesOptions volumes = volumes_options(options.quick);
    volumes.threads = options.threads.value_or(1);
    volumes.seed = options.seed;
    return run_volumes(volumes, !options.quiet);
  }
  if (options.kind == ExperimentOptions::Kind::claims) {
    ClaimsOptions claims = claims_options(options.quick);
    claims.seed = options.seed;
    return run_claims(claims, !options.quiet);
  }
  if (options.kind == ExperimentOptions::Kind::ablation) {
    AblationOptions ablation = ablation_options(options.quick);
    ablation.threads = options.threads.value_or(1);
    ablation.seed = options.seed;
    return run_ablation(ablation, !options.quiet);
  }
  if (options.kind == ExperimentOptions::Kind::trials) {
    TrialOptions trials = trial_options(options.quick);
    trials.seed = options.seed;
    return run_trials(trials, !options.quiet);
  }
  if (options.kind == ExperimentOptions::Kind::sensitivity) {
    SensitivityOptions sensitivity = sensitivity_options(options.quick);
    sensitivity.threads = options.threads;
    sensitivity.seed = options.seed;
    return run_sensitivity(sensitivity, folder, options.resume, !options.quiet);
  }
  if (options.kind == ExperimentOptions::Kind::figures) {
    FiguresOptions figures = figures_options(options.quick);
    figures.seed = options.seed;
    return run_figures(figures, folder, !options.quiet);
  }
  ArityOptions arity = arity_options(options.quick);
  arity.threads = options.threads.value_or(1);
  arity.seed = options.seed;
  return run_arity(arity, !options.quiet);
}

}  // namespace

const char* name_of(ExperimentOptions::Kind kind) {
  using Kind = ExperimentOptions::Kind;
  switch (kind) {
    case Kind::table1:
      return "table1";
    case Kind::scaling:
      return "scaling";
    case Kind::arity:
      return "arity";
    case Kind::volumes:
      return "volumes";
    case Kind::claims:
      return "claims";
    case Kind::ablation:
      return "ablation";
    case Kind::trials:
      return "trials";
    case Kind::sensitivity:
      return "sensitivity";
    case Kind::figures:
      return "figures";
  }
  return "";
}

int run_experiment(const ExperimentOptions& options) {
  const std::filesystem::path folder =
      options.output.empty() ? fmt::format("experiment_{}", name_of(options.kind)) : options.output;
  std::optional<Report> result;
  if (options.kind == ExperimentOptions::Kind::table1) {
    const cli::Interruption interruption;
    result = run_table1(table1_options(options), folder, options.resume, interruption, !options.quiet);
    if (!result) {
      fmt::print(
          stderr,
          "supple: interrupted; {} has the complete runs, and the same command with --resume goes on\n",
          one_line(folder.string()));
      return cli::exit_interrupted + interruption.signal();
    }
  } else {
    result = run(options, folder);
  }
  const Report& report = *result;
  write_report(report, folder);
  if (!options.quiet) fmt::print("{}\n", text_of(report));
  const int exit_status = make_page(folder);
  if (exit_status == cli::exit_done && !options.quiet)
    fmt::print("Written: {}\n", (folder / (report.name + ".html")).string());
  return exit_status;
}

}  // namespace supple::experiments
