#include "experiment.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "options/options.hpp"

namespace supple::experiments {
namespace {

std::string footer() {
  std::string text = "Examples:\n";
  for (const auto& [name, help] : experiments())
    text += fmt::format("  supple experiment {}\n      {}\n", name, help);
  return text + R"(  supple experiment table1 --quick --output quick
      A small version in under a minute, which writes CSV files and quick/table1.html.
  supple experiment table1 --objects 3,6,9 --seconds 0 --program-clock 600 --output clock
      Counts the collisions found in ten minutes of the whole program, as the paper does. Takes hours. Ctrl-C
      stops it; the same command with --resume goes on.
  supple experiment table1 --scene scenes/nine.toml --scene-size 3,4 --bounding-volume sphere --sphere-fit box
      Your own scene in two sizes, with the spheres of the paper's eq. 3 and 4.

Each experiment writes CSV tables and a report as one HTML page into a folder, and reports which of the
paper's claims hold. The report needs python3 with matplotlib and scipy. Without them, the tables are written
and the exit status is 2. experiments/README.md describes the experiments.)";
}

void add_name(CLI::App& app, ExperimentOptions& options) {
  std::vector<std::string> names;
  for (const auto& [name, help] : experiments()) names.push_back(name);
  const auto parse = [&options, names](const std::string& given) {
    if (std::find(names.begin(), names.end(), given) == names.end())
      throw CLI::ValidationError("experiment",
                                 fmt::format("there is no experiment '{}'; choose {} or {}", given,
                                             fmt::join(names.begin(), names.end() - 1, ", "), names.back()));
    options.name = given;
  };
  app.add_option_function<std::string>(fmt::format("{}", fmt::join(names, "|")), parse, "The experiment")
      ->required()
      ->type_name("");
}

/// The lists of scenes, sizes and volumes.
std::vector<CLI::Option*> add_table1_lists(CLI::App& app, ExperimentOptions& options) {
  return {
      cli::add_list(
          app, "--objects",
          [&options](const std::string& given) {
            options.objects.push_back(
                static_cast<std::uint32_t>(cli::whole_of("--objects", ValueRange::from(2, 100'000), given)));
          },
          "Numbers of objects: pawns, fish and rabbits in equal parts (default: 3,6,9 and other scenes)")
          ->type_name("N,..."),
      app.add_option("--scene", options.scenes,
                     "A scene file, or three_humans or three_bikes, to run instead of the built-in scenes; "
                     "may be given several times")
          ->type_name("FILE")
          ->expected(1)
          ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll),
      cli::add_list(
          app, "--scene-size",
          [&options](const std::string& given) {
            options.scene_sizes.push_back(cli::real_of("--scene-size", ValueRange::above(0), given));
          },
          "Edge of the cube that reflects the objects; each scene runs in each size (default: the border "
          "of the scene)")
          ->type_name("D,..."),
      cli::add_list(
          app, "--bounding-volume",
          [&options, is_default = true](const std::string& given) mutable {
            if (std::exchange(is_default, false)) options.method.volumes.clear();
            options.method.volumes.push_back(static_cast<BoundingVolume>(cli::index_of_word(
                "--bounding-volume", {words<BoundingVolume>.begin(), words<BoundingVolume>.end()}, given)));
          },
          "Shapes of objects and nodes to compare (default: aabb,sphere)")
          ->type_name("aabb,sphere,...")};
}

void add_table1(CLI::App& app, ExperimentOptions& options, cli::Dependences& dependences) {
  const auto is_table1 = [&options] { return options.name == "table1"; };
  const auto table1_only = [&](CLI::Option* option) {
    option->description("table1: " + option->get_description());
    dependences.push_back({option, is_table1, "table1"});
  };
  const auto add_needs = [&](CLI::Option* option, std::string_view key) {
    for (const cli::OptionNeed& need : cli::option_needs()) {
      if (key == need.key)
        dependences.push_back({option, [&options, need] { return is_met(need, options.method); },
                               cli::flag_of(need.decider) + " " + need.values});
    }
  };
  constexpr const char* root_key = "scene_octree_root";
  for (CLI::Option* const option : add_table1_lists(app, options)) table1_only(option);
  for_each_option(
      [&](const auto& field, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        CLI::Option* const option =
            cli::add_field(app, field, value, [&value](const Value& given) { value = given; });
        table1_only(option);
        add_needs(option, field.key);
      },
      options.method);
  CLI::Option* const root =
      cli::add_root(app, root_key, options.method.root_is_border,
                    [&options](const RootCube& cube) { options.method.scene.scene_octree.root = cube; });
  table1_only(root);
  add_needs(root, root_key);
  table1_only(cli::add_words(
      app, "--integrator", {words<Integrator>.begin(), words<Integrator>.end()},
      [&options](std::size_t place) { options.method.integrator = static_cast<Integrator>(place); },
      "Integrator of all mass-spring bodies (default: that of the scene)"));
  table1_only(
      cli::add_number(app, "--runs", options.runs, 1, 1000, "Number of runs per configuration (default: 5)"));
  table1_only(cli::add_number(app, "--seconds", options.simulated_seconds, 0, 1'000'000,
                              "Simulated seconds per run; 0 means no runs in simulated time (default: 600)"));
  dependences.push_back(
      {app.get_option("--seconds"),
       [&options] { return options.simulated_seconds.value_or(1) > 0 || options.program_clock; },
       "--program-clock when it is 0"});
  table1_only(
      cli::add_number(app, "--program-clock", options.program_clock, 1, 1'000'000,
                      "Also count the collisions that the whole program finds in this many seconds of "
                      "detection and motion in each run"));
  CLI::Option* const fused = cli::add_words(
      app, "--fused-refit", {"off", "on"},
      [&options](std::size_t place) { options.method.fused_refit = place == 1; },
      "The loop of the motion finds the bounds of the bodies, instead of a loop of the refit (default: on)");
  table1_only(fused);
  dependences.push_back(
      {fused, [&options] { return options.method.scene.comparison.lazy_refit; }, "--lazy-refit on"});
  CLI::Option* const resume =
      app.add_flag("--resume", options.resume,
                   "Go on with the experiment in the output folder; what is complete is not repeated");
  CLI::Option* const threads =
      cli::add_number(app, "--threads", options.threads, 0, 1024,
                      "Parallel runs in simulated time, of one thread each (default and 0: one per core)");
  for (CLI::Option* const option : {resume, threads}) {
    option->description("table1 and sensitivity: " + option->get_description());
    dependences.push_back({option, [&options] { return options.has_log(); }, "table1 or sensitivity"});
  }
}

}  // namespace

void add_options(CLI::App& app, ExperimentOptions& options, cli::Dependences& dependences) {
  app.footer(footer());
  add_name(app, options);
  app.add_flag("--quick", options.quick, "Run a small version, in under a minute");
  app.add_option("--output", options.output, "Folder for the results (default: experiment_NAME)")
      ->type_name("DIR");
  cli::add_number(app, "--seed", options.seed, 0, 1'000'000'000, "Seed of the random numbers (default: 1)");
  add_table1(app, options, dependences);
  app.add_flag("--quiet", options.quiet, "Print no tables and no progress");
}

}  // namespace supple::experiments
