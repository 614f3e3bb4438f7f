#include "options/option_groups.hpp"

#include <fmt/core.h>

#include <charconv>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "options/help_footers.hpp"
#include "session/pins/pin_values.hpp"
#include "session/program/attach_descriptions.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::cli {
namespace {

CLI::Option* add_view_file(CLI::App& app, ViewOptions& options) {
  return app
      .add_option("--view", options.view_file,
                  "View file, which the page saves: camera, layers, colours and more; see docs/viewer.md "
                  "(default: the view that the page begins with)")
      ->type_name("VIEW.json");
}

/// A whole number at the start of a text, which is removed; nothing when there is none.
std::optional<std::uint64_t> take_whole(std::string_view& text) {
  std::uint64_t number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// `A`, `A-B` or `A-B:STEP`.
FrameRange parse_frames(const std::string& given) {
  std::string_view rest = given;
  const auto next = [&](char separator, std::uint64_t otherwise) -> std::optional<std::uint64_t> {
    if (!rest.starts_with(separator)) return otherwise;
    rest.remove_prefix(1);
    return take_whole(rest);
  };
  const auto first = take_whole(rest);
  const auto last = next('-', first.value_or(0));
  const auto every = next(':', 1);
  constexpr std::uint64_t most = 1'000'000'000;
  if (!first || !last || !every || !rest.empty() || *last < *first || *every == 0 || *last > most)
    throw CLI::ValidationError(
        "--frames",
        fmt::format("'{}' is not A, A-B or A-B:STEP with whole numbers A <= B <= {} and STEP >= 1", given,
                    most));
  return {*first, *last, *every};
}

/// `1600x1200` in pixels or `160x120mm`.
RenderOptions::Size parse_size(const std::string& given) {
  RenderOptions::Size size;
  std::string_view text = given;
  size.is_in_millimetres = text.ends_with("mm");
  if (size.is_in_millimetres) text.remove_suffix(2);
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto number = [&](std::string_view part) -> std::optional<double> {
    if (size.is_in_millimetres) return parse_number(part);
    const auto whole = take_whole(part);
    return whole && part.empty() ? std::optional<double>(static_cast<double>(*whole)) : std::nullopt;
  };
  const auto width = number(text.substr(0, cross));
  const auto height = cross < text.size() ? number(text.substr(cross + 1)) : std::nullopt;
  if (!width || !height || !(*width > 0) || !(*height > 0))
    throw CLI::ValidationError(
        "--size", fmt::format("'{}' is not WIDTHxHEIGHT in whole pixels, nor WIDTHxHEIGHTmm", given));
  size.width = *width;
  size.height = *height;
  return size;
}

/// An option that keeps its word.
CLI::Option* add_word(CLI::App& app, const std::string& name, const std::vector<const char*>& words,
                      std::string& value, const std::string& description) {
  return add_words(
      app, name, words, [&value, words](std::size_t place) { value = words[place]; },
      fmt::format("{} (default: {})", description, value));
}

/// The plots of the page by name: those of every run, and the values of pins, of which a vector is one.
std::vector<std::string> names_of_plots() {
  std::vector<std::string> names{"pairs", "contacts", "times"};
  for_each_field<viewer::PinValues>([&](const auto& field) {
    std::string_view value = field.name;
    if (value.ends_with("_x") || value.ends_with("_y") || value.ends_with("_z")) value.remove_suffix(2);
    if (std::string name = fmt::format("pin-{}", value); name != names.back())
      names.push_back(std::move(name));
  });
  return names;
}

CLI::Option* add_plot(CLI::App& app, RenderOptions& options) {
  static const std::vector<std::string> names = names_of_plots();
  std::vector<const char*> words;
  for (const std::string& name : names) words.push_back(name.c_str());
  return add_words(
      app, "--plot", words, [&options](std::size_t place) { options.plot = names[place]; },
      "Draw a plot over the frames instead of the scene: pairs of objects, contacts, times of the stages, or "
      "a value of the pins in the view file. A simulation needs --frames. Of a recording, pins have the "
      "values of these frames");
}

void add_picture_options(CLI::App& app, RenderOptions& options, Dependences& dependences) {
  const Heading add{"Pictures", dependences};
  const auto is_png = [&options] { return !options.is_svg; };
  const auto of_scene = [&](CLI::Option* option) {
    return add(
        option, [&options] { return options.plot.empty(); }, "a picture of the scene, which --plot replaces");
  };
  add(app.add_option_function<std::string>(
             "-o,--output",
             [&options](const std::string& name) {
               options.output = name;
               options.is_svg = name.ends_with(".svg");
               if (!options.is_svg && !name.ends_with(".png"))
                 throw CLI::ValidationError("--output", name + " ends neither in .png nor in .svg");
             },
             "PNG files, or SVG files of lines: outlines, wireframes, contact segments and points. %04d "
             "stands for the number of the frame")
          ->type_name("FILE")
          ->required());
  add(add_view_file(app, options));
  add(app.add_option_function<std::string>(
             "--frames", [&options](const std::string& given) { options.frames = parse_frames(given); },
             "Frames of a recording, or steps of a simulation, each STEP-th (default: the one of the view "
             "file, or 0; with --plot, all frames of a recording)")
          ->type_name("A-B:STEP"));
  add(app.add_option_function<std::string>(
             "--size", [&options](const std::string& given) { options.size = parse_size(given); },
             "Width and height in pixels, or in millimetres, as 160x120mm (default: 1600x1200)")
          ->type_name("WxH|WxHmm"));
  add(add_real(app, "--dpi", ValueRange::from(10, 2400), "", options.dpi,
               "Pixels per inch: of sizes in millimetres, and the scale of texts and marks (default: 200)"));
  add(add_plot(app, options));
  of_scene(add_word(app, "--background", {"white", "transparent", "theme"}, options.background,
                    "What is behind the objects; theme is that of the page, with its floor and axes"));
  add(
      add_word(app, "--theme", {"light", "dark"}, options.theme,
               "Colours of the background and of texts on it"),
      [&options] { return options.background != "white"; }, "--background theme or transparent");
  of_scene(app.add_flag("--legend", options.legend,
                        "Draw the names of the visible objects with their colours, but not of those that a "
                        "field covers"));
  of_scene(app.add_flag("--colour-bar", options.colour_bar,
                        "Draw the colours of the field that the view file chooses, with their values"));
  of_scene(app.add_flag("--scale-bar", options.scale_bar,
                        "Draw a bar of a round length. It holds everywhere in an orthographic view, and at "
                        "the target of the camera in perspective, which the picture then says"));
  add(app.add_option("--browser", options.browser,
                     "Chromium that draws the pictures (default: the variable SUPPLE_CHROMIUM, or the first "
                     "one in PATH)")
          ->type_name("PATH"));
  of_scene(add(app.add_flag("--gpu", options.uses_graphics_card,
                            "Draw on the graphics card; otherwise the browser draws in software, which gives "
                            "the same pictures on every machine"),
               is_png, "PNG files"));
  add(app.add_flag("--quiet", options.quiet, "Print no progress and no summary"));
}

}  // namespace

/// Adds options that replace values of the scene file.
void add_scene_overrides(CLI::App& app, std::optional<std::uint64_t>& seed,
                         std::optional<double>& time_step) {
  for_each_field<SimulationOptions>([&]<class Value>(const Field<SimulationOptions, Value>& field) {
    const auto add = [&](auto& given) {
      add_field(app, field, Value{}, [&given](const Value& value) { given = value; })
          ->group("Simulation")
          ->description(std::string(field.doc) + "; replaces the value of the scene file");
    };
    if constexpr (std::is_same_v<Value, double>) add(time_step);
    if constexpr (std::is_same_v<Value, std::uint64_t>) add(seed);
  });
}

void add_view(CLI::App& program, ViewOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand("view",
                                         "Show moving objects in a browser with their contacts and the "
                                         "stages that find them; objects can be pulled");
  app->footer(view_footer);
  add_input_options(*app, options);
  add_frames(*app, options.reading.clips.frames, "Number of frames of the animation of a file")
      ->group("Input");
  add_scene_overrides(*app, options.seed, options.time_step);
  add_detection_options(*app, options, dependences, true);
  add_fused_refit(*app, options, dependences);

  const Heading add{"Page", dependences};
  const auto served = [&](CLI::Option* option) {
    add(
        option, [&] { return options.page_file.empty(); }, "a page that is served, not written by --export");
  };
  const auto add_megabytes = [&](const char* name, double& bytes, const char* description) {
    const auto set = [&bytes](std::uint64_t megabytes) { bytes = 1e6 * static_cast<double>(megabytes); };
    served(add_whole(*app, name, ValueRange::from(0, 1'000'000'000), set, description));
  };
  served(add_whole(
      *app, "--port", ValueRange::from(0, 65535),
      [&](std::uint64_t port) { options.port = static_cast<std::uint16_t>(port); },
      "Port of the server; 0 means any free port (default: 0)"));
  served(app->add_option("--host", options.address,
                         "IP address of the server. With an address other than 127.0.0.1, people on other "
                         "machines who know the full address can see and control the page (default: "
                         "127.0.0.1)")
             ->type_name("ADDRESS"));
  served(app->add_option("--token-file", options.token_file,
                         "File with the secret part of the address, made when it does not exist: with "
                         "--port, the address stays the same, and an open page connects again after a "
                         "restart (default: a new secret in each run)")
             ->type_name("FILE"));
  served(app->add_flag("--spectators", options.has_spectators, viewer::spectators_doc));
  served(app->add_flag_callback(
      "--no-open", [&] { options.open_browser = false; }, "Print the address without opening a browser"));
  add_megabytes("--max-memory", options.budget.bytes,
                "Memory in MB that commands of the page may add to that of the scene as opened, as estimated "
                "for its objects, vertices and triangles (default: 2000)");
  add_megabytes("--history", options.budget.history_bytes,
                "Memory in MB for the positions of the last steps of a simulation, which the page can go "
                "back to; with 0 it keeps none, and objects have no speeds (default: 500)");
  served(app->add_flag("--follow", options.follow,
                       "Show the frames of a recording that is still being written as they are saved"));
  add(
      app->add_option("--compare", options.compared,
                      "Show a second recording with the first, frame by frame, and where the two differ "
                      "first")
          ->type_name("RUN.h5"),
      [&] { return options.page_file.empty() && !options.follow; },
      "a page that is served, without --follow");
  add(
      add_real(*app, "--tolerance", ValueRange::from(0), "length", options.tolerance,
               "Largest difference of two coordinates that --compare takes as equal (default: 0)"),
      [&] { return !options.compared.empty(); }, "--compare");
  add(add_view_file(*app, options));
  add(app->add_option("--export", options.page_file,
                      "Write one HTML file instead of starting a server: any browser can show it, and the "
                      "detection runs in the page")
          ->type_name("PAGE.html"));
}

void add_render(CLI::App& program, RenderOptions& options, Dependences& dependences) {
  CLI::App* app = program.add_subcommand(
      "render", "Draw frames of a scene or a recording as PNG or SVG files, without a window");
  app->footer(render_footer);
  add_input_options(*app, options);
  add_scene_overrides(*app, options.seed, options.time_step);
  add_detection_options(*app, options, dependences, true);
  add_fused_refit(*app, options, dependences);
  add_picture_options(*app, options, dependences);
}

}  // namespace supple::cli
