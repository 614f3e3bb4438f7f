#include "experiment.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/interruption.hpp"
#include "base/run_program.hpp"
#include "program_2007/program_2007.hpp"
#include "results.hpp"
#include "studies/studies.hpp"
#include "supple/error.hpp"
#include "supple/utf8.hpp"
#include "table1/table1_runs.hpp"

namespace supple::experiments {
namespace {

struct Experiment {
  const char* name;
  Results (*run)(const Request& request);  ///< none: its runs are in a log
  const char* help;
};

constexpr std::array all_experiments{
    Experiment{"table1", nullptr,
               "The paper's Table 1: collisions of 3, 6, 9 and more objects, with boxes and with spheres. "
               "Takes hours."},
    Experiment{"scaling", run_scaling,
               "Time against the number of objects, up to 1,000,000, and of vertices."},
    Experiment{"arity", run_arity, "Trees of two, four and eight children."},
    Experiment{"volumes", run_volumes,
               "Boxes, spheres, oriented boxes and k-DOPs, and ways to build an octree."},
    Experiment{"claims", run_claims, "Single claims: the cost of one test, the depth of octrees, stability."},
    Experiment{"ablation", run_ablation,
               "From the program of 2007 to the defaults of today, one choice at a time."},
    Experiment{"trials", run_trials, "The methods that the paper tried and rejected."},
    Experiment{"sensitivity", nullptr,
               "Whether other scenes, speeds or levels give the numbers of the paper. Takes hours."},
    Experiment{"figures", run_figures, "Data of the paper's figures: modules, regions and pairs of nodes."}};

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

}  // namespace

std::vector<std::pair<std::string, std::string>> experiments() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const Experiment& experiment : all_experiments) names.emplace_back(experiment.name, experiment.help);
  return names;
}

int run_experiment(const ExperimentOptions& options) {
  const Request request{options.quick, options.seed,
                        options.output.empty() ? "experiment_" + options.name : options.output,
                        !options.quiet};
  if (options.has_log()) {
    if (options.resume && !std::filesystem::exists(request.folder))
      throw Error(fmt::format("--resume: {} has no experiment; leave out --resume to start one",
                              request.folder.string()));
    const cli::Interruption interruption;
    const auto run = options.name == "table1" ? run_table1 : run_sensitivity;
    if (!run(table1_options(options), request, options.resume, interruption)) {
      fmt::print(
          stderr,
          "supple: interrupted; {} has the complete runs, and the same command with --resume goes on\n",
          one_line(request.folder.string()));
      return cli::exit_interrupted + interruption.signal();
    }
  } else {
    const auto* const experiment = std::find_if(all_experiments.begin(), all_experiments.end(),
                                                [&](const Experiment& e) { return e.name == options.name; });
    Results results = experiment->run(request);
    results.parameters.emplace_back("seed", fmt::format("{}", options.seed));
    write_results(results, request.folder);
  }
  return judge(request.folder, options.quiet);
}

}  // namespace supple::experiments
