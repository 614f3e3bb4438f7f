#include "options.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "documents.hpp"
#include "exit_status.hpp"
#include "supple/version.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

constexpr const char* program_footer = R"(Examples:
  supple detect rabbit.obj fish.ply         which triangles of the two intersect?
  supple detect --help                      every option, with examples
  supple info rabbit.obj                    counts, bounds, holes, octree statistics

Exit status: 0 done; 1 with --fail-on-contact when something touches; 2 usage or input error, told in one line;
3 with --verify when brute force disagrees.)";

constexpr const char* detect_footer = R"(Examples:
  supple detect rabbit.obj fish.ply
      Two static meshes, an object each: which of their triangles intersect?
  supple detect --self cloth.obj --json result.json
      Where does a cloth cut through itself? Each contact with its points, as JSON.
  supple detect --sequence 'frame_*.ply' --self --csv pairs.csv
      Frames of one object. Quote the pattern: frame_10 then comes after frame_9, not after frame_1.
  supple detect scene.toml --steps 300
      A scene file: objects with placement, options and motion.
  supple detect a.stl b.stl --fail-on-contact --quiet && echo apart
      For scripts: the exit status is 1 when anything touches.
  supple detect rabbit.obj fish.ply --verify
      Check the result against exact brute force over all pairs of triangles.
  supple detect a.obj b.obj --json - --no-stats | sha256sum
      The same input gives the same bytes for any number of threads and any broad phase.)";

constexpr const char* info_footer = R"(Examples:
  supple info rabbit.obj
      Counts, bounds, closed or open, connected pieces, and how good its octree is.
  supple info scans/*.ply --json -
      The same of many meshes as JSON on standard output.
  supple info scene.toml
      Every object of a scene, as placed.)";

/// An option that takes one of a few words. The first choice is the default.
template <class Enum>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Enum& value,
                        const std::vector<std::pair<std::string, Enum>>& choices,
                        const std::string& description) {
  std::string words, alternatives;
  for (const auto& [word, meaning] : choices) {
    words += (words.empty() ? "" : "|") + word;
    alternatives += (alternatives.empty() ? "" : ", ") + word;
  }
  const auto parse = [&value, choices, alternatives, name](const std::string& given) {
    for (const auto& [word, meaning] : choices) {
      if (word != given) continue;
      value = meaning;
      return;
    }
    throw CLI::ValidationError(name, fmt::format("'{}' is not one of {}", given, alternatives));
  };
  return app
      .add_option_function<std::string>(name, parse,
                                        fmt::format("{} (default: {})", description, choices.front().first))
      ->type_name(words);
}

/// A number from `lowest` to `highest`.
template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& value, std::uint32_t lowest,
                        std::uint32_t highest, const std::string& description) {
  const auto parse = [&value, lowest, highest, name](const std::string& given) {
    std::uint32_t number = 0;
    if (!CLI::detail::lexical_cast(given, number) || number < lowest || number > highest ||
        given.find_first_not_of("0123456789") != std::string::npos)
      throw CLI::ValidationError(
          name, fmt::format("'{}' is not a whole number from {} to {}", given, lowest, highest));
    value = number;
  };
  return app.add_option_function<std::string>(name, parse, description)->type_name("N");
}

CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& value,
                      const std::string& description) {
  return app.add_option(name, value, description)->type_name("FILE|-");
}

std::array<CLI::Option*, 2> add_octree_options(CLI::App& app, std::optional<std::uint32_t>& max_level,
                                               std::optional<std::uint32_t>& leaf_size) {
  const ObjectOctreeOptions defaults;
  return {
      add_number(app, "--max-level", max_level, 0, 32,
                 fmt::format("Deepest level of an object's octree (default: {})", defaults.max_level)),
      add_number(app, "--leaf-size", leaf_size, 1, 1'000'000'000,
                 fmt::format("Triangles up to which a node is not split (default: {})", defaults.leaf_size))};
}

/// An option that means something only together with a certain choice of another.
struct Dependence {
  const CLI::Option* option;
  std::function<bool()> satisfied;
  std::string needs;
};
using Dependences = std::vector<Dependence>;

void check(const Dependences& dependences) {
  for (const Dependence& d : dependences) {
    if (d.option->count() > 0 && !d.satisfied())
      throw CLI::ValidationError(d.option->get_name(), "has no effect without " + d.needs);
  }
}

void add_input_options(CLI::App& app, DetectOptions& options) {
  app.add_option("MESH|SCENE.toml", options.inputs, "Meshes, an object each; or one scene file")
      ->required()
      ->type_name("");
  app.add_flag(
         "--sequence", options.sequence,
         "The meshes are frames of one object, in the order given; a quoted pattern such as 'frame_*.ply' "
         "gives its files in natural number order")
      ->group("Input");
  add_number(app, "--steps", options.steps, 1, 1'000'000'000,
             "Frames of a scene file to go through (default: 1)")
      ->group("Input");
}

void add_stage_options(CLI::App& app, DetectOptions& options, Dependences& dependences) {
  SceneOptions& scene = options.scene;
  const auto group = [](CLI::Option* option) { return option->group("Detection"); };
  group(add_choice<ContactMode>(app, "--contacts", scene.contacts,
                                {{"intersection", ContactMode::intersection}, {"none", ContactMode::none}},
                                "Exact stage: every intersecting pair of triangles, or object pairs only"));
  group(app.add_flag("--self", options.self, "Also test every object against itself"));
  group(app.add_flag_callback(
      "--no-contact-points", [&] { scene.contact_points = false; }, "Leave out the points of each contact"));
  dependences.push_back({group(app.add_flag("--fail-on-contact", options.fail_on_contact,
                                            "Exit with status 1 when anything touches")),
                         [&] { return scene.contacts != ContactMode::none; }, "--contacts intersection"});
  dependences.push_back({group(app.add_flag("--verify", options.verify,
                                            "Check each frame against exact brute force over all pairs of "
                                            "triangles; differences exit with status 3")),
                         [&] { return scene.contacts != ContactMode::none; }, "--contacts intersection"});
  group(
      add_number(app, "--threads", scene.threads, 0, 1024, "Worker threads, 0 for one a core (default: 0)"));
}

void add_method_options(CLI::App& app, DetectOptions& options, Dependences& dependences) {
  SceneOptions& scene = options.scene;
  const auto group = [](CLI::Option* option) { return option->group("Method"); };
  const auto with_spheres = [&] { return scene.bounding_volume == BoundingVolume::sphere; };
  group(add_choice<BoundingVolume>(app, "--bounding-volume", scene.bounding_volume,
                                   {{"aabb", BoundingVolume::aabb}, {"sphere", BoundingVolume::sphere}},
                                   "Shape that encloses objects and the nodes of their octrees"));
  dependences.push_back(
      {group(add_choice<SphereFit>(
           app, "--sphere-fit", scene.sphere_fit,
           {{"vertices", SphereFit::vertices}, {"box", SphereFit::box}},
           "Spheres about the vertices, or as the paper's eq. 3 and 4, which miss contacts")),
       with_spheres, "--bounding-volume sphere"});
  group(add_choice<BroadPhaseMethod>(app, "--broad-phase", scene.broad_phase,
                                     {{"octree", BroadPhaseMethod::octree},
                                      {"sweep", BroadPhaseMethod::sweep},
                                      {"brute", BroadPhaseMethod::brute}},
                                     "How object pairs are found; all find the same"));
  dependences.push_back(
      {group(add_choice<RegionSphereTest>(
           app, "--region-test", scene.scene_octree.region_sphere_test,
           {{"arvo", RegionSphereTest::arvo}, {"grown-box", RegionSphereTest::grown_box}},
           "Region of the scene octree against a sphere: Arvo's test or the paper's")),
       [&, with_spheres] { return with_spheres() && scene.broad_phase == BroadPhaseMethod::octree; },
       "--bounding-volume sphere and --broad-phase octree"});
  for (CLI::Option* option : add_octree_options(app, options.max_level, options.leaf_size)) group(option);
}

void add_output_options(CLI::App& app, DetectOptions& options, Dependences& dependences) {
  const auto group = [](CLI::Option* option) { return option->group("Output"); };
  group(
      add_file(app, "--json", options.json, "Write the whole result, frame by frame; - is standard output"));
  group(add_file(app, "--csv", options.csv,
                 "Write a row a triangle pair: frame,a,b,i,j; - is standard output"));
  dependences.push_back({group(app.add_flag_callback(
                             "--no-stats", [&] { options.json_stats = false; },
                             "Leave times and counts out of the JSON, so that equal results are "
                             "equal files")),
                         [&] { return !options.json.empty(); }, "--json"});
  group(app.add_flag("--quiet", options.quiet, "No tables and no progress"));
}

CLI::App* add_detect(CLI::App& program, DetectOptions& options, Dependences& dependences) {
  CLI::App* app =
      program.add_subcommand("detect", "Find every contact of static meshes, a sequence or a scene");
  app->footer(detect_footer);
  add_input_options(*app, options);
  add_stage_options(*app, options, dependences);
  add_method_options(*app, options, dependences);
  add_output_options(*app, options, dependences);
  return app;
}

CLI::App* add_info(CLI::App& program, InfoOptions& options) {
  CLI::App* app = program.add_subcommand("info", "Say what meshes are like, and the octrees built from them");
  app->footer(info_footer);
  app->add_option("MESH|SCENE.toml", options.inputs, "Meshes, or one scene file")->required()->type_name("");
  add_octree_options(*app, options.max_level, options.leaf_size);
  add_file(*app, "--json", options.json, "Write the same as JSON; - is standard output");
  return app;
}

void check_outputs(const DetectOptions& options) {
  if (options.json == "-" && options.csv == "-")
    throw CLI::ValidationError("--csv", "--json already writes to standard output; give one of them a file");
}

int print_usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const auto used = program.get_subcommands();
  const std::string command = used.empty() ? "supple" : "supple " + used.front()->get_name();
  fmt::print(stderr, "{}: {}; see {} --help\n", command, one_line(error.what()), command);
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
  program.add_option("--generate", document, "Print a document made from these options: man or markdown")
      ->group("");

  Dependences dependences;
  const CLI::App* detect = add_detect(program, result.detect, dependences);
  const CLI::App* info = add_info(program, result.info);
  try {
    program.parse(argument_count, arguments);
    if (!document.empty()) {
      print_document(program, document);
      return result;
    }
    if (program.get_subcommands().empty()) throw CLI::RequiredError::Subcommand(1);
    check(dependences);
    check_outputs(result.detect);
    result.command = detect->parsed() ? CommandLine::Command::detect : CommandLine::Command::info;
    (void)info;
  } catch (const CLI::Success& success) {  // help and version
    result.exit_status = program.exit(success);
  } catch (const CLI::ParseError& error) {
    result.exit_status = print_usage_error(program, error);
  }
  return result;
}

}  // namespace supple::cli
