#include "options/option_groups.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <type_traits>

#include "base/interruption.hpp"
#include "options/option_needs.hpp"
#include "session/settings.hpp"
#include "supple/format_descriptions.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::cli {
namespace {

constexpr std::array tested_object_keys{"self", "neighbours", "weld", "margin", "solid"};

}  // namespace

void add_weld(CLI::App& app, viewer::Overrides<ObjectOptions>& objects) {
  objects.for_each_setter([&]<class Struct, class Value>(const Field<Struct, Value>& field,
                                                         const Value& default_value, auto set) {
    if constexpr (std::is_same_v<Value, bool>) {
      if (field.key == std::string_view("weld")) add_field(app, field, default_value, set);
    }
  });
}

CLI::Option* add_max_contacts(CLI::App& app, RunLimits& limits, const char* description) {
  return add_whole(
      app, "--max-contacts", ValueRange::from(1, 1e18),
      [&limits](std::uint64_t number) { limits.max_contacts = number; }, description);
}

CLI::Option* add_time_limit(CLI::App& app, RunLimits& limits) {
  return add_real(
      app, "--time-limit", ValueRange::above(0), "s",
      [&limits](double seconds) {
        limits.seconds = seconds;
        start_time_limit(seconds);
      },
      "End this wall-clock time after the start: the results so far are written, and the JSON and CSV say "
      "that "
      "they are truncated; if the input is still being read then, nothing is written (default: no limit)");
}

void add_object_options(CLI::App& app, viewer::Overrides<ObjectOptions>& objects, bool are_tested) {
  objects.for_each_setter([&]<class Struct, class Value>(const Field<Struct, Value>& field,
                                                         const Value& default_value, auto set) {
    if constexpr (std::is_same_v<Struct, ObjectOctreeOptions>) {
      add_field(app, field, default_value, set)->group(are_tested ? "Method" : "Options");
    } else if constexpr (!std::is_same_v<Value, std::string>) {
      const auto& keys = tested_object_keys;
      if (are_tested && std::find(keys.begin(), keys.end(), std::string_view(field.key)) != keys.end())
        add_field(app, field, default_value, set)->group("Detection");
    }
  });
}

void add_parts(CLI::App& app, bool& parts, const char* group) {
  app.add_flag(
         "--parts", parts,
         "Each connected part of a mesh is an object of its own: triangles and edges that share a "
         "vertex, or a position with --weld, are connected. With --solid, the parts that are closed and "
         "oriented alike are solid")
      ->group(group);
}

CLI::Option* add_frames(CLI::App& app, std::optional<std::uint64_t>& frames, const char* description) {
  return add_number(app, "--frames,--steps", frames, 1, 1'000'000'000, description);
}

void add_conversion(CLI::App& app, CoordinateConversion& conversion) {
  for_each_field<CoordinateConversion>([&](const auto& field) {
    add_field(app, field, conversion.*field.member, [&conversion, member = field.member](auto value) {
      conversion.*member = value;
    })->group("Input");
  });
}

void add_input_options(CLI::App& app, InputOptions& options) {
  MeshReading& reading = options.reading;
  app.add_option("MESH|SCENE.toml|RUN.h5", options.inputs,
                 "Meshes, one per object; or one scene file; or one recording")
      ->required()
      ->type_name("");
  CLI::Option* const frames =
      app.add_flag(
             "--sequence", options.sequence,
             "The meshes are frames of one object, in the order of the command line; a quoted pattern such "
             "as 'frame_*.ply' is sorted by the numbers in the names")
          ->group("Input");
  const auto group = [frames](CLI::Option* option) { option->group("Input")->excludes(frames); };
  group(app.add_option("--clip", reading.clips.clip,
                       "Animation of glTF, FBX or COLLADA files to play, by name (default: the first)")
            ->type_name("NAME"));
  group(add_real(app, "--fps", ValueRange::above(0), "frames per second", reading.clips.fps,
                 "Play the animation at this rate (default: with --frames N, N frames evenly from its start "
                 "to its end; otherwise 25)"));
  group(
      app.add_option("--cache", reading.cache,
                     "Point cache with the positions of the mesh in each frame; its vertices have the order "
                     "of the mesh file")
          ->type_name("FILE.pc2|FILE.mdd"));
  add_conversion(app, reading.conversion);
}

void add_detection_options(CLI::App& app, MethodOptions& options, Dependences& dependences, bool of_page) {
  options.given_scene.for_each_setter([&]<class Struct, class Value>(const Field<Struct, Value>& field,
                                                                     const Value& default_value, auto set) {
    if (of_page && !viewer::is_setting(field) && !field.is_of_machine) return;
    const bool is_method =
        std::is_same_v<Struct, SceneOctreeOptions> ||
        (std::is_same_v<Struct, ComparisonOptions> && field.key != std::string_view("colliding_vertices")) ||
        std::is_same_v<Value, BoundingVolume> || std::is_same_v<Value, BroadPhaseMethod>;
    CLI::Option* option = nullptr;
    if constexpr (std::is_same_v<Value, std::optional<RootCube>>)
      option = add_root(app, field.key, options.root_is_border, set);
    else
      option = add_field(app, field, default_value, set);
    option->group(is_method ? "Method" : "Detection");
    for (const OptionNeed& need : option_needs()) {
      if (std::string_view(field.key) == need.key)
        dependences.push_back({option, [&options, need] { return need.is_met(options.scene); },
                               flag_of(need.decider) + " " + need.values});
    }
  });
  dependences.push_back(
      {app.add_flag(
              "--as-2007", options.as_2007,
              "Run the method of the paper's program: the scene octree of Figure 2 with regions down to "
              "level 2, regular octrees of single triangles, the descent of Figure 4, fused and lazy "
              "refit, and the colliding vertices. Other options change parts of it")
           ->group("Method"),
       [&options] { return is_at_rest(options.scene); }, "--contacts intersection or none"});
  add_object_options(app, options.given_objects, true);
  add_parts(app, options.parts, "Detection");
  dependences.push_back({app.get_option("--margin"), [&options] { return has_margins(options.scene); },
                         "--contacts proximity"});
  dependences.push_back({app.get_option("--neighbours"),
                         [&options] { return has_intersections(options.scene); }, "--contacts intersection"});
  dependences.push_back({app.get_option("--solid"), [&options] { return has_penetration(options.scene); },
                         "--contacts penetration"});
}

void add_fused_refit(CLI::App& app, MethodOptions& options, Dependences& dependences) {
  for_each_field<SimulationOptions>([&]<class Struct, class Value>(const Field<Struct, Value>& field) {
    if constexpr (std::is_same_v<Value, bool>) {
      const auto set = [&options](bool fused) { options.fused_refit = fused; };
      dependences.push_back({add_field(app, field, false, set)->group("Method"),
                             [&options] { return options.scene.comparison.lazy_refit; }, "--lazy-refit on"});
    }
  });
}

void add_report_options(CLI::App& app, DetectionOptions& options, Dependences& dependences) {
  const auto add = [&](const char* name, bool& value, const char* description) {
    Heading{"Detection", dependences}(
        app.add_flag(name, value, description),
        [&options] { return options.scene.contacts != ContactKinds::none; },
        "--contacts intersection or another kind");
  };
  add("--fail-on-contact", options.fail_on_contact,
      "Exit with status 1 when anything touches, is near with --contacts proximity, or is inside a solid "
      "with --contacts penetration; otherwise with status 2 when a kind of contacts had nothing to test");
  add("--verify", options.verify,
      "Check each frame by exact brute force over all pairs of triangles, elements, or vertices and "
      "triangles; exit with status 3 when the results differ");
}

void add_output_options(CLI::App& app, DetectionOptions& options, Dependences& dependences) {
  const Heading add{"Output", dependences};
  const auto has_json = [&options] { return !options.json.empty(); };
  const auto has_one_kind = [&options] {
    if (options.scene.comparison.colliding_vertices) return true;
    const auto kinds = static_cast<unsigned>(options.scene.contacts);
    const auto included = static_cast<unsigned>(ContactKinds::intersection);
    return std::popcount(has_penetration(options.scene) ? kinds & ~included : kinds) == 1;
  };
  const auto has_details = [&options] {
    const bool has_table = !options.csv.empty() && !options.scene.comparison.colliding_vertices;
    return (!options.json.empty() || has_table) && options.scene.contacts != ContactKinds::none;
  };
  const auto has_tables = [&options] {
    return !options.json.empty() || (!options.quiet && options.csv != "-");
  };
  add(add_file(app, "--json", options.json, "Write all results, frame by frame; - is standard output"));
  add(add_file(app, "--csv", options.csv,
               "Write one row per contact; with penetration, one per vertex inside a solid. The first row "
               "names the columns; - is standard output. With --colliding-vertices the columns are "
               "frame,a,b,kind,i,j: also for each vertex in colliding leaves, and for the begin and end of "
               "each collision of the narrow phase"),
      has_one_kind, "contacts of one kind");
  add(app.add_flag_callback(
          "--no-stats", [&] { options.json_content.stats = false; },
          "Leave options, times and counts out of the JSON, so that equal results give equal files"),
      has_json, "--json");
  add(app.add_flag("--contact-details", options.json_content.contact_details,
                   "Also write each contact to the JSON: for triangles the kind, the normal and the points; "
                   "for continuous contacts the barycentric coordinates, the point and the normal; for "
                   "proximity also both points; for penetration the way out, and the points and enclosed "
                   "vertices of curves. Adds vectors and barycentric coordinates to the CSV"),
      has_details, "--json or --csv, and contacts");
  add(app.add_flag("--faces", options.json_content.faces,
                   "Also write the three vertices of each triangle to the JSON; a polygon of n corners is n "
                   "- 2 triangles"),
      has_json, "--json");
  add(app.add_option_function<std::vector<std::uint32_t>>(
             "--node-pairs",
             [&options](const std::vector<std::uint32_t>& objects) {
               options.json_content.node_pairs = {objects[0], objects[1]};
             },
             "Print the descent of the narrow phase into the octrees of two objects, by number, as in the "
             "paper: the pairs of nodes (h, k) that collide, level by level, in the last frame. The JSON has "
             "all pairs of every frame")
          ->type_name("A B")
          ->expected(2),
      has_tables, "--json or tables on standard output");
  add(app.add_flag("--quiet", options.quiet, "Print no tables and no progress"));
}

}  // namespace supple::cli
