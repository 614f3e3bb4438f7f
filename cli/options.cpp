#include "options.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "documents.hpp"
#include "exit_status.hpp"
#include "experiments/experiment_options.hpp"
#include "option_kinds.hpp"
#include "recorded_input.hpp"
#include "session/settings.hpp"
#include "supple/recording.hpp"
#include "supple/simulation_descriptions.hpp"
#include "supple/version.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

constexpr const char* program_footer = R"(Examples:
  supple detect rabbit.obj fish.ply         which triangles of the two intersect?
  supple detect --contacts continuous --self --sequence 'frame_*.obj'
                                            what passes through something between two frames, and when?
  supple detect --help                      every option, with examples
  supple simulate scene.toml --frames 300 --record run.h5
                                            objects that move by themselves, and what touches on the way
  supple view run.h5                        the same in a browser, live or recorded
  supple info rabbit.obj                    counts, bounds, holes, octree statistics
  supple ccd-queries edge-edge/*.csv        single continuous queries, compared with the answers known
  supple experiment scaling --quick         how does time grow with the number of objects, and does the paper say so?
  supple diff a.h5 b.h5                     where do two recordings differ first?

Exit status: 0 done; 1 with --fail-on-contact when something touches, and of diff when recordings differ; 2 usage or
input error, told in one line, and of simulate a motion that blows up; 3 with --verify when brute force disagrees, and of
ccd-queries when an answer is false; 130 and 143 of simulate when it is interrupted, after it has closed its files.
view ends by that, with 0.)";

constexpr const char* detect_footer = R"(Examples:
  supple detect rabbit.obj fish.ply
      Two static meshes, an object each: which of their triangles intersect?
  supple detect --self cloth.obj --json result.json --contact-details
      Where does a cloth intersect itself? Each contact with its points, as JSON.
  supple detect --sequence 'frame_*.ply' --self --csv pairs.csv
      Frames of one object. Quote the pattern: frame_10 then comes after frame_9, not after frame_1.
  supple detect scene.toml --frames 300
      A scene file: objects with placement, options and motion.
  supple detect run.h5 --verify
      A recording: each of its frames again, with the recorded options. Options given here come first.
  supple detect a.stl b.stl --fail-on-contact --quiet && echo apart
      For scripts: the exit status is 1 when anything touches.
  supple detect --contacts continuous --self --sequence 'frame_*.ply' --json impacts.json
      What passes through something between two frames: each vertex and face, each two edges, and when they first meet.
  supple detect --contacts continuous --min-separation 0.001 scene.toml --frames 300
      Elements already touch when they come within 0.001.
  supple detect rabbit.obj fish.ply --verify
      Check the result against exact brute force over all pairs of triangles.
  supple detect a.obj b.obj --json - --no-stats | sha256sum
      The same input gives the same bytes for any number of threads and any broad phase.)";

constexpr const char* diff_footer = R"(Examples:
  supple diff a.h5 b.h5
      The first frame and item in which two recordings differ, with both values; the exit status is 1 when they do.
  supple diff a.h5 b.h5 --tolerance 1e-9
      Positions and points of contacts, and the times, barycentric coordinates and normals of continuous contacts,
      may differ by 1e-9.
  supple diff a.h5 b.h5 --quiet && echo equal
      For scripts.
  supple diff a.h5 b.h5 --json -
      The same as JSON on standard output.

Seconds that were measured, and counts that depend on the number of threads, are not compared.)";

constexpr const char* simulate_footer = R"(Examples:
  supple simulate scenes/rabbit_pile.toml
      Rabbits fall on each other: what touched, how fast it went, and where the time was spent.
  supple simulate scenes/fish_tank.toml --seconds 10 --record run.h5
      Every frame and contact in an HDF5 file; ParaView opens the run.xdmf beside it.
  supple simulate scenes/table1_9.toml --frames 1000 --seed 7 --json - --no-stats
      Another seed sends objects off in other directions; the same seed gives the same bytes everywhere.
  supple simulate scenes/cloth_over_ball.toml --contacts continuous --self
      Also what passes through something between two frames, and through itself.
  supple simulate scenes/soft_block.toml --time-step 0.001
      Shorter steps than the scene file's.

Frame 0 is the start, and frame k is the state after k steps. The continuous contacts of frame k are those of the way
from frame k - 1 to frame k. Ctrl-C ends the run after the step that is under way, with its files and tables complete.)";

constexpr const char* view_footer = R"(Examples:
  supple view scenes/nine.toml
      Objects that bend and meet: watch, pull at a vertex, look into the octrees.
  supple view run.h5
      A recording of supple simulate --record: play, go back, jump to where objects begin to touch.
  supple view rabbit.obj fish.ply
      Meshes, an object each: where do they meet, and why not elsewhere?
  supple view --sequence 'frame_*.ply' --self
      Frames of one object, with what it does to itself.
  supple view scenes/soft_block.toml --no-open --port 8080
      On another machine: ssh -L 8080:127.0.0.1:8080 brings the page to yours.
  supple view scenes/nine.toml --export nine.html
      One file to send: whoever opens it can do the same, without supple and without a server.

The address has a token, another one each time, which keeps others out. The browser is led there by a file that only you can
read, which goes when the program ends; a browser from a Snap or a Flatpak may not see that file: open the address itself
there. Ctrl-C ends the program; the page says so.)";

constexpr const char* info_footer = R"(Examples:
  supple info rabbit.obj
      Counts, bounds, closed or open, connected pieces, and how good its octree is.
  supple info scans/*.ply --json -
      The same of many meshes as JSON on standard output.
  supple info scene.toml
      Every object of a scene, as placed.)";

constexpr const char* ccd_queries_footer = R"(Examples:
  supple ccd-queries sample-queries/*/vertex-face/*.csv
      How many touch, how many of the answers in the files are missed, and the time a query takes?
  supple ccd-queries --kind edge-edge queries.csv --list-false
      The kind is told by a folder named vertex-face or edge-edge, or a file name that ends in vf or ee; else say it.
  supple ccd-queries 227vf.csv --answers 227vf_mma_bool.json
      Answers from a JSON list of true and false.
  supple ccd-queries data.csv --kind vertex-face --min-separation 0.01 --verify
      Elements touch that come within 0.01; algebra decides each query anew.
  supple ccd-queries 227vf.csv --json - --no-stats
      The time of every impact as JSON, the same bytes in every run.

A query is eight rows: the vertices v, f0, f1, f2 of a vertex and a face, or a0, a1, b0, b1 of two edges, at the start
of the step, and the same at its end. A row is numerator,denominator of x, y and z, whole numbers of any size, and
perhaps the answer, 0 or 1, the same in all eight. Each coordinate must be exactly a double.)";

/// The octree of each object, and `--self` where objects are tested.
void add_object_options(CLI::App& app, viewer::Overrides<ObjectOptions>& objects, bool are_tested) {
  objects.for_each_setter([&]<class Struct, class Value>(const Field<Struct, Value>& field,
                                                         const Value& default_value, auto set) {
    if constexpr (std::is_same_v<Struct, ObjectOctreeOptions>) {
      add_field(app, field, default_value, set)->group(are_tested ? "Method" : "Options");
    } else if constexpr (std::is_same_v<Value, bool>) {
      if (are_tested && std::string_view(field.key) == "self")
        add_field(app, field, default_value, set)->group("Detection");
    }
  });
}

void add_impact_options(CLI::App& app, ImpactOptions& impact) {
  for_each_leaf(
      [&](const auto& field, auto& value) {
        add_field(app, field, value, [&value](const auto& given) { value = given; });
      },
      impact);
}

CLI::Option* add_frames(CLI::App& app, std::optional<std::uint64_t>& frames, const char* description) {
  return add_number(app, "--frames,--steps", frames, 1, 1'000'000'000, description);
}

void add_kind(CLI::App& app, std::optional<QueryKind>& kind) {
  add_words(
      app, "--kind", {words<QueryKind>.begin(), words<QueryKind>.end()},
      [&kind](std::size_t place) { kind = static_cast<QueryKind>(place); },
      "What the queries are about (default: by the names of folders and files)");
}

/// Meshes, a scene file, a recording, or frames.
void add_input_options(CLI::App& app, std::vector<std::string>& inputs, bool& sequence) {
  app.add_option("MESH|SCENE.toml|RUN.h5", inputs, "Meshes, an object each; or one scene file or recording")
      ->required()
      ->type_name("");
  app.add_flag(
         "--sequence", sequence,
         "The meshes are frames of one object, in the order given; a quoted pattern such as 'frame_*.ply' "
         "gives its files in natural number order")
      ->group("Input");
}

bool is_continuous(const SceneOptions& scene) {
  return contains(scene.contacts, ContactKinds::continuous);
}
bool has_spheres(const SceneOptions& scene) {
  return scene.bounding_volume == BoundingVolume::sphere;
}
bool has_scene_octree(const SceneOptions& scene) {
  return viewer::uses_scene_octree(scene.broad_phase);
}

/// What an option of the scene needs to have an effect.
struct Need {
  const char* key;
  bool (*is_met)(const SceneOptions& scene);
  const char* text;
};
constexpr Need needs_of_options[] = {
    {"sphere_fit", has_spheres, "--bounding-volume sphere"},
    {"region_test", [](const SceneOptions& scene) { return has_spheres(scene) && has_scene_octree(scene); },
     "--bounding-volume sphere and --broad-phase octree or automatic"},
    {"scene_octree_max_level", has_scene_octree, "--broad-phase octree or automatic"},
    {"scene_octree_expand_at", has_scene_octree, "--broad-phase octree or automatic"},
    {"scene_octree_arity", has_scene_octree, "--broad-phase octree or automatic"},
    {"min_separation", is_continuous, "--contacts continuous"},
    {"undecided", is_continuous, "--contacts continuous"},
    {"contact_points", [](const SceneOptions& scene) { return scene.contacts != ContactKinds::continuous; },
     "--contacts intersection"},
    {"colliding_vertices",
     [](const SceneOptions& scene) { return scene.contacts != ContactKinds::continuous; },
     "--contacts intersection or none"},
};

/// Every option of the detection; a page has a layer instead of `--colliding-vertices`.
void add_detection_options(CLI::App& app, MethodOptions& options, Dependences& dependences,
                           bool of_page = false) {
  options.given_scene.for_each_setter([&]<class Struct, class Value>(const Field<Struct, Value>& field,
                                                                     const Value& default_value, auto set) {
    if (of_page && !viewer::is_setting(field) && !field.is_of_machine) return;
    const bool is_method = std::is_same_v<Struct, SceneOctreeOptions> ||
                           std::is_same_v<Value, BoundingVolume> || std::is_same_v<Value, SphereFit> ||
                           std::is_same_v<Value, BroadPhaseMethod>;
    CLI::Option* const option =
        add_field(app, field, default_value, set)->group(is_method ? "Method" : "Detection");
    for (const Need& need : needs_of_options) {
      if (std::string_view(field.key) == need.key)
        dependences.push_back({option, [&options, need] { return need.is_met(options.scene); }, need.text});
    }
  });
  add_object_options(app, options.given_objects, true);
}

void add_report_options(CLI::App& app, DetectionOptions& options, Dependences& dependences) {
  const auto add = [&](const char* name, bool& value, const char* description) {
    dependences.push_back({app.add_flag(name, value, description)->group("Detection"),
                           [&options] { return options.scene.contacts != ContactKinds::none; },
                           "--contacts intersection or continuous"});
  };
  add("--fail-on-contact", options.fail_on_contact, "Exit with status 1 when anything touches");
  add("--verify", options.verify,
      "Check each frame against exact brute force over all pairs of triangles, or of elements; differences "
      "exit with status 3");
}

void add_output_options(CLI::App& app, DetectionOptions& options, Dependences& dependences) {
  const auto group = [](CLI::Option* option) { return option->group("Output"); };
  group(
      add_file(app, "--json", options.json, "Write the whole result, frame by frame; - is standard output"));
  dependences.push_back(
      {group(add_file(app, "--csv", options.csv,
                      "Write a row a contact: frame,a,b,i,j of triangles, or "
                      "frame,a,b,kind,a0,a1,b0,b1,time,certainty; - is standard output")),
       [&] { return options.scene.contacts != (ContactKinds::intersection | ContactKinds::continuous); },
       "contacts of one kind"});
  dependences.push_back({group(app.add_flag_callback(
                             "--no-stats", [&] { options.json_content.stats = false; },
                             "Leave options, times and counts out of the JSON, so that equal results are "
                             "equal files")),
                         [&] { return !options.json.empty(); }, "--json"});
  dependences.push_back(
      {group(app.add_flag("--contact-details", options.json_content.contact_details,
                          "Also write each contact to the JSON: of triangles the kind and the points, of "
                          "elements the barycentric coordinates, the point and the normal")),
       [&] { return !options.json.empty() && options.scene.contacts != ContactKinds::none; },
       "--json and contacts"});
  dependences.push_back({group(app.add_flag("--faces", options.json_content.faces,
                                            "Also write the three vertices of each triangle to the JSON; a "
                                            "polygon is a fan of triangles around its first corner")),
                         [&] { return !options.json.empty(); }, "--json"});
  group(app.add_flag("--quiet", options.quiet, "No tables and no progress"));
}

CLI::App* add_detect(CLI::App& program, DetectOptions& options, Dependences& dependences) {
  CLI::App* app =
      program.add_subcommand("detect", "Find every contact of static meshes, a sequence or a scene");
  app->footer(detect_footer);
  add_input_options(*app, options.inputs, options.sequence);
  add_frames(*app, options.frames,
             "Number of frames (default: all of a sequence, a recording or the files of a scene; of another "
             "scene the first, or the first two with continuous contacts)")
      ->group("Input");
  add_detection_options(*app, options, dependences);
  add_report_options(*app, options, dependences);
  add_output_options(*app, options, dependences);
  return app;
}

/// What is given instead of the scene file's.
void add_scene_overrides(CLI::App& app, std::optional<std::uint64_t>& seed,
                         std::optional<double>& time_step) {
  for_each_field<SimulationOptions>([&]<class Value>(const Field<SimulationOptions, Value>& field) {
    const auto add = [&](auto& given) {
      add_field(app, field, Value{}, [&given](const Value& value) { given = value; })
          ->group("Simulation")
          ->description(std::string(field.doc) + "; instead of the scene file's");
    };
    if constexpr (std::is_same_v<Value, double>) add(time_step);
    if constexpr (std::is_same_v<Value, std::uint64_t>) add(seed);
  });
}

void add_simulation_options(CLI::App& app, SimulateOptions& options) {
  app.add_option("SCENE.toml", options.input, "A scene file")->required()->type_name("");
  const auto group = [](CLI::Option* option) { return option->group("Simulation"); };
  CLI::Option* const frames = group(add_frames(
      app, options.frames, "Number of frames; the first is the start (default: 301, which are 300 steps)"));
  group(add_real(
            app, "--seconds", ValueRange::above(0), "s", [&](double seconds) { options.seconds = seconds; },
            "Simulated time, instead of a number of frames"))
      ->excludes(frames);
  add_scene_overrides(app, options.seed, options.time_step);
}

CLI::App* add_simulate(CLI::App& program, SimulateOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand(
      "simulate", "Let the objects of a scene move by themselves, and find every contact on the way");
  app->footer(simulate_footer);
  add_simulation_options(*app, options);
  add_detection_options(*app, options, dependences);
  add_report_options(*app, options, dependences);
  app->add_option("--record", options.record,
                  "Write positions, contacts, events and statistics of each frame as HDF5, and an XDMF file "
                  "beside it that ParaView opens")
      ->type_name("FILE.h5")
      ->group("Output");
  add_output_options(*app, options, dependences);
  return app;
}

CLI::App* add_view(CLI::App& program, ViewOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand(
      "view", "Watch objects move and collide in a browser, pull at them, and see what finds the contacts");
  app->footer(view_footer);
  add_input_options(*app, options.inputs, options.sequence);
  add_scene_overrides(*app, options.seed, options.time_step);
  add_detection_options(*app, options, dependences, true);

  const auto group = [](CLI::Option* option) { return option->group("Page"); };
  const auto is_served = [&] { return options.page_file.empty(); };
  const char* const no_export = "a page that is served, not written by --export";
  dependences.push_back({group(add_whole(
                             *app, "--port", ValueRange::from(0, 65535),
                             [&](std::uint64_t port) { options.port = static_cast<std::uint16_t>(port); },
                             "Where to listen, 0 for any port that is free (default: 0)")),
                         is_served, no_export});
  dependences.push_back(
      {group(app->add_option("--host", options.address,
                             "IP address to listen at; with any but this machine's own others who reach "
                             "it and know the address can look and steer (default: 127.0.0.1)")
                 ->type_name("ADDRESS")),
       is_served, no_export});
  dependences.push_back(
      {group(app->add_flag_callback(
           "--no-open", [&] { options.open_browser = false; }, "Print the address, but open no browser")),
       is_served, no_export});
  group(app->add_option("--export", options.page_file,
                        "Write one HTML file instead, which needs no server: any browser shows it, the "
                        "detection runs in the page")
            ->type_name("PAGE.html"));
  return app;
}

CLI::App* add_info(CLI::App& program, InfoOptions& options) {
  CLI::App* app = program.add_subcommand("info", "Say what meshes are like, and the octrees built from them");
  app->footer(info_footer);
  app->add_option("MESH|SCENE.toml", options.inputs, "Meshes, or one scene file")->required()->type_name("");
  add_object_options(*app, options.given_objects, false);
  add_file(*app, "--json", options.json, "Write the same as JSON; - is standard output");
  return app;
}

CLI::App* add_ccd_queries(CLI::App& program, CcdQueriesOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand(
      "ccd-queries",
      "Put single vertex-face and edge-edge queries of continuous collision, as published with answers");
  app->footer(ccd_queries_footer);
  app->add_option("FILE.csv", options.inputs, "Files of queries")->required()->type_name("");
  add_kind(*app, options.kind);
  app->add_option("--answers", options.answers,
                  "JSON list of true and false, one a query, for a file without a column of answers; once "
                  "for each file, "
                  "in the same order")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_impact_options(*app, options.impact);
  app->add_flag(
      "--verify", options.verify,
      "Decide each query by algebra too, and compare outcome and time; differences exit with status 3");
  dependences.push_back(
      {app->add_flag("--list-false", options.list_false, "Name each query that was answered falsely"),
       [&] { return !options.quiet && options.json != "-"; }, "tables on standard output"});
  add_file(*app, "--json", options.json,
           "Write the time of every impact and all counts; - is standard output");
  dependences.push_back({app->add_flag_callback(
                             "--no-stats", [&] { options.json_stats = false; },
                             "Leave measured times out of the JSON, so that equal results are equal files"),
                         [&] { return !options.json.empty(); }, "--json"});
  app->add_flag("--quiet", options.quiet, "No table and no progress");
  return app;
}

void add_diff(CLI::App& program, DiffOptions& options) {
  CLI::App* app = program.add_subcommand("diff", "Say in which frame and item two recordings differ first");
  app->footer(diff_footer);
  app->add_option("RECORDING.h5", options.recordings, "The two recordings")
      ->required()
      ->expected(2)
      ->type_name("");
  add_real(
      *app, "--tolerance", ValueRange::from(0), "length",
      [&](double tolerance) { options.tolerance = tolerance; },
      "Coordinates may differ by so much, in their unit (default: 0, the same bits)");
  add_file(*app, "--json", options.json, "Write the same as JSON; - is standard output");
  app->add_flag("--quiet", options.quiet, "Only the exit status");
}

/// The options of the detection: those of a recording, or the defaults, with those given in their place.
void resolve(MethodOptions& options, const std::vector<std::string>& inputs) {
  if (!inputs.empty() && is_recording(inputs.front()))
    options.scene = Recording(inputs.front()).header().scene;
  SceneOptions chosen = options.scene;
  options.given_scene.apply_to(chosen);
  // Recorded options of the scene octree go with a recorded method.
  if (!has_scene_octree(chosen)) options.scene.scene_octree = {};
  options.given_scene.apply_to(options.scene);
}

void check_outputs(const DetectionOptions& options) {
  if (options.scene.comparison.colliding_vertices && options.json.empty())
    throw CLI::ValidationError("--colliding-vertices", "has no effect without --json");
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
  // The first word that was not expected; `--flag=value` is one.
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

CommandLine parse_command_line(int argument_count, const char* const* arguments) {
  CommandLine result;
  CLI::App program("Finds every collision between triangle meshes that bend, exactly.", "supple");
  program.footer(program_footer);
  program.set_version_flag("--version", "supple " SUPPLE_VERSION, "Print the version and exit");
  program.require_subcommand(0, 1);
  std::string document;
  program
      .add_option("--generate", document, "Print a document made from these options: man, markdown or tables")
      ->group("");

  Dependences dependences;
  const CLI::App* detect = add_detect(program, result.detect, dependences);
  const CLI::App* simulate = add_simulate(program, result.simulate, dependences);
  const CLI::App* view = add_view(program, result.view, dependences);
  const CLI::App* info = add_info(program, result.info);
  const CLI::App* ccd_queries = add_ccd_queries(program, result.ccd_queries, dependences);
  add_diff(program, result.diff);
  const CLI::App* experiment = experiments::add_experiment(program, result.experiment, dependences);
  try {
    program.parse(argument_count, arguments);
    if (!document.empty()) {
      print_document(program, document);
      return result;
    }
    if (program.get_subcommands().empty()) throw CLI::RequiredError::Subcommand(1);
    resolve(result.detect, result.detect.inputs);
    resolve(result.simulate, {});
    resolve(result.view, result.view.inputs);
    check(dependences);
    check_outputs(result.detect);
    check_outputs(result.simulate);
    result.command = detect->parsed()        ? CommandLine::Command::detect
                     : simulate->parsed()    ? CommandLine::Command::simulate
                     : view->parsed()        ? CommandLine::Command::view
                     : info->parsed()        ? CommandLine::Command::info
                     : ccd_queries->parsed() ? CommandLine::Command::ccd_queries
                     : experiment->parsed()  ? CommandLine::Command::experiment
                                             : CommandLine::Command::diff;
  } catch (const CLI::Success& success) {  // help and version
    result.exit_status = program.exit(success);
  } catch (const CLI::ParseError& error) {
    result.exit_status = print_usage_error(program, error);
  }
  return result;
}

}  // namespace supple::cli
