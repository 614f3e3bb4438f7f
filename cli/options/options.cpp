#include "options/options.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <type_traits>

#include "base/run_program.hpp"
#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "options/help_footers.hpp"
#include "options/option_groups.hpp"
#include "options/option_kinds.hpp"
#include "scene_file/scene_file.hpp"
#include "session/settings.hpp"
#include "supple/comparison.hpp"
#include "supple/format_descriptions.hpp"
#include "supple/recording.hpp"
#include "supple/simulation_descriptions.hpp"
#include "supple/version.hpp"

namespace supple::cli {
namespace {

/// The options of the detection that the input has: those of a recording or of a scene file.
SimulationOptions options_of(const std::vector<std::string>& inputs) {
  SimulationOptions options{.scene = default_scene_options()};
  if (inputs.empty()) return options;
  if (is_recording(inputs.front())) options.scene = Recording(inputs.front()).header().scene;
  if (is_scene_file(inputs.front())) options = read_scene_options(inputs.front());
  return options;
}

void add_detect(CLI::App& program, DetectOptions& options, Dependences& dependences) {
  CLI::App* app =
      program.add_subcommand("detect", "Find every contact of static meshes, a sequence or a scene");
  app->footer(detect_footer);
  add_input_options(*app, options);
  add_frames(*app, options.frames,
             "Number of frames (default: all frames of a sequence, a recording or a scene with mesh files as "
             "frames; otherwise one frame, or two with continuous contacts); plays the animation of a file")
      ->group("Input");
  add_detection_options(*app, options, dependences);
  // Objects of scene files and recordings have options of their own.
  const auto needs_of_meshes = [&options, app](const char* option, const char* need, const auto& is_met) {
    const auto has_effect = [&options, is_met] {
      const bool are_meshes = !options.inputs.empty() && !is_scene_file(options.inputs.front()) &&
                              !is_recording(options.inputs.front());
      return !are_meshes || is_met();
    };
    return Dependence{app->get_option(option), has_effect, need};
  };
  dependences.push_back(
      needs_of_meshes("--neighbours", "--self", [app] { return app->count("--self") > 0; }));
  dependences.push_back(needs_of_meshes("--skip-parting", "--min-separation",
                                        [&options] { return options.scene.impact.min_separation > 0; }));
  add_report_options(*app, options, dependences);
  dependences.push_back(
      {add_max_contacts(
           *app, options.limits,
           "Find at most this many contacts of each kind in a frame, the first ones in the order of "
           "the results; the JSON and CSV say that they are truncated (default: no limit)")
           ->group("Detection"),
       [&options] {
         return options.scene.contacts != ContactKinds::none && !has_penetration(options.scene) &&
                !options.verify;
       },
       "contacts other than penetration, and no --verify"});
  add_time_limit(*app, options.limits)->group("Detection");
  add_output_options(*app, options, dependences);
}

void add_simulation_options(CLI::App& app, SimulateOptions& options) {
  app.add_option("SCENE.toml", options.input, "A scene file")->required()->type_name("");
  const auto group = [](CLI::Option* option) { return option->group("Simulation"); };
  CLI::Option* const frames =
      group(add_frames(app, options.frames,
                       "Number of frames; frame 0 is the start (default: 301 frames, which are 300 steps)"));
  group(add_real(app, "--seconds", ValueRange::above(0), "s", options.seconds,
                 "Simulated time; instead of --frames"))
      ->excludes(frames);
  add_scene_overrides(app, options.seed, options.time_step);
}

void add_simulate(CLI::App& program, SimulateOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand(
      "simulate", "Simulate the motion of the objects of a scene and find their contacts in each frame");
  app->footer(simulate_footer);
  add_simulation_options(*app, options);
  add_detection_options(*app, options, dependences);
  add_fused_refit(*app, options, dependences);
  add_report_options(*app, options, dependences);
  add_time_limit(*app, options.limits)->group("Detection");
  app->add_option("--record", options.record,
                  "Write positions, contacts, events and statistics of each frame to an HDF5 file, and an "
                  "XDMF file for ParaView next to it")
      ->type_name("FILE.h5")
      ->group("Output");
  add_output_options(*app, options, dependences);
}

void add_info(CLI::App& program, InfoOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand("info", "Print statistics of meshes and of their octrees");
  app->footer(info_footer);
  app->add_option("MESH|SCENE.toml", options.inputs, "Meshes, or one scene file")->required()->type_name("");
  add_conversion(*app, options.conversion);
  options.given_scene.for_each_setter([&]<class Struct, class Value>(const Field<Struct, Value>& field,
                                                                     const Value& default_value, auto set) {
    if constexpr (std::is_same_v<Value, BoundingVolume>) {
      add_field(*app, field, default_value, set);
    } else if constexpr (std::is_same_v<Value, SphereFit>) {
      const auto has_spheres_given = [&options] {
        SceneOptions scene = options_of(options.inputs).scene;
        options.given_scene.apply_to(scene);
        return has_spheres(scene);
      };
      dependences.push_back(
          {add_field(*app, field, default_value, set), has_spheres_given, "--bounding-volume sphere"});
    }
  });
  app->add_flag("--as-2007", options.as_2007, "The paper's octrees: regular, down to single triangles");
  add_object_options(*app, options.given_objects, false);
  add_weld(*app, options.given_objects);
  add_parts(*app, options.parts, "Options");
  add_file(*app, "--json", options.json, "Write the result as JSON; - is standard output");
}

CLI::App* add_query(CLI::App& program, QueryOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand("query",
                                         "Find the nearest triangles of points, the points inside, the first "
                                         "triangles on rays, or the distances of objects");
  app->footer(query_footer);
  add_conversion(*app, options.conversion);
  app->add_option_function<std::string>(
         "KIND",
         [&options](const std::string& word) {
           const auto place = std::ranges::find(words<SceneQuery>, word);
           if (place == words<SceneQuery>.end())
             throw CLI::ValidationError("KIND", word + " is none of closest, inside, rays and distance");
           options.kind = static_cast<SceneQuery>(place - words<SceneQuery>.begin());
         },
         "The question: closest, inside, rays or distance")
      ->required()
      ->type_name("");
  app->add_option("FILE.txt", options.file, "Points or rays; leave it out for the question distance")
      ->type_name("");
  app->add_option("MESH|SCENE.toml|RUN.h5", options.inputs,
                  "Meshes, one per object; or one scene file; or one recording")
      ->type_name("");
  const Heading add{"Options", dependences};
  add(
      add_real(*app, "--max-distance", ValueRange::from(0), "length", options.max_distance,
               "Leave out triangles and objects that are farther away than this (default: any distance)"),
      [&] { return options.kind == SceneQuery::closest || options.kind == SceneQuery::distance; },
      "the question closest or distance");
  add(
      app->add_flag("--signed", options.signed_distance,
                    "Distances of points inside are negative; the surfaces must be closed"),
      [&] { return options.kind == SceneQuery::closest; }, "the question closest");
  add(
      app->add_flag("--all-hits", options.all_hits, "Also count all triangles on each ray"),
      [&] { return options.kind == SceneQuery::rays; }, "the question rays");
  options.given_scene.for_each_setter([&]<class Struct, class Value>(const Field<Struct, Value>& field,
                                                                     const Value& default_value, auto set) {
    if constexpr (std::is_same_v<Value, std::uint32_t>) {
      if (field.is_of_machine) add_field(*app, field, default_value, set);
    }
  });
  add_weld(*app, options.given_objects);
  add_parts(*app, options.parts, "Options");
  add_max_contacts(
      *app, options.limits,
      "Write at most this many results: answers of the first points or rays, or the first pairs of "
      "objects; the JSON says that they are truncated (default: no limit)");
  add_time_limit(*app, options.limits);
  app->add_flag("--verify", options.verify,
                "Check each answer by exact brute force over all triangles; exit with status 3 when one is "
                "wrong");
  add_file(*app, "--json", options.json, "Write the results as JSON; - is standard output");
  app->add_flag("--quiet", options.quiet, "Print no table and no progress");
  return app;
}

/// The question distance has no file of points: the first argument is an input then.
void sort_arguments(QueryOptions& options) {
  if (options.kind == SceneQuery::distance && !options.file.empty()) {
    options.inputs.insert(options.inputs.begin(), options.file);
    options.file.clear();
  }
  if (options.kind != SceneQuery::distance && options.file.empty()) throw CLI::RequiredError("FILE.txt");
  if (options.inputs.empty()) throw CLI::RequiredError("MESH|SCENE.toml|RUN.h5");
}

void add_ccd_queries(CLI::App& program, CcdQueriesOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand("ccd-queries",
                                         "Answer published vertex-face and edge-edge queries of continuous "
                                         "collision, and compare with their answers");
  app->footer(ccd_queries_footer);
  app->add_option("FILE.csv", options.inputs, "Files of queries")->required()->type_name("");
  add_words(
      *app, "--kind", {words<QueryKind>.begin(), words<QueryKind>.end()},
      [&options](std::size_t place) { options.kind = static_cast<QueryKind>(place); },
      "Kind of the queries (default: from the names of folders and files)");
  app->add_option("--answers", options.answers,
                  "JSON list with true or false for each query, for files without a column of answers; give "
                  "the option once per file, in the same order")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  for_each_leaf(
      [&](const auto& field, auto& value) {
        const std::string_view key = field.key;  // the others have no effect on the answer of a single query
        if (key == "min_separation" || key == "undecided")
          add_field(*app, field, value, [&value](const auto& given) { value = given; });
      },
      options.impact);
  app->add_flag("--verify", options.verify,
                "Also decide each query by algebra, and compare the result and the time; exit with status 3 "
                "when they differ");
  const Heading add{"Options", dependences};
  add(
      app->add_flag("--list-false", options.list_false,
                    "List each query whose result differs from its published answer"),
      [&] { return !options.quiet && options.json != "-"; }, "tables on standard output");
  add_file(*app, "--json", options.json,
           "Write the time of every impact and all counts; - is standard output");
  add(
      app->add_flag_callback(
          "--no-stats", [&] { options.json_stats = false; },
          "Leave measured times out of the JSON, so that equal results give equal files"),
      [&] { return !options.json.empty(); }, "--json");
  app->add_flag("--quiet", options.quiet, "Print no table and no progress");
}

void add_diff(CLI::App& program, DiffOptions& options) {
  CLI::App* app =
      program.add_subcommand("diff", "Find the first frame and item in which two recordings differ");
  app->footer(diff_footer);
  app->add_option("RECORDING.h5", options.recordings, "The two recordings")
      ->required()
      ->expected(2)
      ->type_name("");
  add_real(*app, "--tolerance", ValueRange::from(0), "length", options.tolerance,
           "Largest difference of coordinates that counts as equal, in their unit (default: 0, the same "
           "bits)");
  add_file(*app, "--json", options.json, "Write the result as JSON; - is standard output");
  app->add_flag("--quiet", options.quiet, "Print nothing; only set the exit status");
}

/// Sets the options of the detection: those of the input, or the defaults, replaced by the given options.
void resolve(MethodOptions& options, const std::vector<std::string>& inputs) {
  const SimulationOptions input = options_of(inputs);
  options.scene = input.scene;
  if (!options.fused_refit) options.fused_refit = options.as_2007 || input.fused_refit;
  if (options.as_2007) {
    options.scene = with_method_of_2007(options.scene);
    if (input.border) options.scene.scene_octree.root = cube_around((*input.border)[0], (*input.border)[1]);
  }
  SceneOptions chosen = options.scene;
  options.given_scene.apply_to(chosen);
  // Options of the scene octree in the input apply only to the method in the input.
  if (!has_scene_octree(chosen)) options.scene.scene_octree = {};
  options.given_scene.apply_to(options.scene);
  if (!options.scene.comparison.lazy_refit) options.fused_refit = false;
  if (!options.root_is_border) return;
  if (!input.border)
    throw CLI::ValidationError("--scene-octree-root", "border: only a scene file with bounds has a border");
  options.scene.scene_octree.root = cube_around((*input.border)[0], (*input.border)[1]);
}

void check_outputs(const DetectionOptions& options, bool prints_collisions) {
  SceneOptions given;
  options.given_scene.apply_to(given);
  if (given.comparison.colliding_vertices && options.json.empty() && options.csv.empty() &&
      !prints_collisions)
    throw CLI::ValidationError("--colliding-vertices", "has no effect without --json or --csv");
  if (options.json == "-" && options.csv == "-")
    throw CLI::ValidationError("--csv", "--json already writes to standard output; give one of them a file");
}

/// The commands of a program, or the options of a command.
std::vector<std::string> names_in(const CLI::App& app, bool of_options) {
  std::vector<std::string> names;
  if (of_options) {
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  } else {
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name());
  }
  return names;
}

int print_usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const auto used = program.get_subcommands();
  const CLI::App& app = used.empty() ? program : *used.front();
  const std::string command = used.empty() ? "supple" : "supple " + app.get_name();
  std::string message = one_line(error.what());
  // The first unexpected word; `--flag=value` is one word.
  if (const std::vector<std::string> unknown = app.remaining(true);
      dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !unknown.empty()) {
    const std::string word = one_line(unknown.front().substr(0, unknown.front().find('=')));
    const bool is_option = word.starts_with('-');
    message = fmt::format("{} {} is unknown",
                          is_option      ? "option"
                          : used.empty() ? "command"
                                         : "argument",
                          word);
    if (const auto nearest = nearest_of(word, names_in(app, is_option)))
      message += fmt::format("; did you mean {}?", *nearest);
  }
  fmt::print(stderr, "{}: {}; see {} --help\n", command, message, command);
  return exit_unusable;
}

}  // namespace

CommandLine parse_command_line(int argument_count, const char* const* arguments,
                               const std::function<void(CLI::App&, Dependences&)>& add_options) {
  CommandLine result;
  CLI::App program("Finds every collision between deforming triangle meshes, exactly.", "supple");
  program.footer(program_footer);
  program.set_version_flag("--version", "supple " SUPPLE_VERSION, "Print the version and exit");
  program.require_subcommand(0, 1);
  bool describes = false;
  program.add_flag("--describe", describes, "Print what documents are made from, as JSON")->group("");

  Dependences dependences;
  // In the order of `CommandLine::Command`.
  add_detect(program, result.detect, dependences);
  add_simulate(program, result.simulate, dependences);
  add_view(program, result.view, dependences);
  add_render(program, result.render, dependences);
  add_info(program, result.info, dependences);
  const CLI::App* query = add_query(program, result.query, dependences);
  add_ccd_queries(program, result.ccd_queries, dependences);
  add_diff(program, result.diff);
  CLI::App* const experiment = program.add_subcommand(
      "experiment", "Repeat the paper's experiments and report which of its claims hold");
  if (add_options) add_options(*experiment, dependences);
  try {
    program.parse(argument_count, arguments);
    if (describes) {
      describe_program(program);
      return result;
    }
    if (program.get_subcommands().empty()) throw CLI::RequiredError::Subcommand(1);
    resolve(result.detect, result.detect.inputs);
    resolve(result.simulate, {result.simulate.input});
    resolve(result.view, result.view.inputs);
    resolve(result.render, result.render.inputs);
    if (query->parsed()) sort_arguments(result.query);
    check(dependences);
    check_outputs(result.detect, false);
    check_outputs(result.simulate, true);
    const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
    const auto given = std::ranges::find_if(commands, [](const CLI::App* app) { return app->parsed(); });
    result.command = static_cast<CommandLine::Command>(given - commands.begin());
  } catch (const CLI::Success& success) {  // help and version
    result.exit_status = program.exit(success);
  } catch (const CLI::ParseError& error) {
    result.exit_status = print_usage_error(program, error);
  }
  return result;
}

}  // namespace supple::cli
