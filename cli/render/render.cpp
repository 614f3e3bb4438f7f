#include "commands/commands.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/interruption.hpp"
#include "base/progress.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "export/page_file.hpp"
#include "render/browser.hpp"
#include "render/picture_names.hpp"
#include "server/server.hpp"
#include "session/messages/json_text.hpp"
#include "session/messages/json_value.hpp"
#include "supple/error.hpp"
#include "view/build_scene_view.hpp"
#include "view_file/view_file.hpp"

namespace supple::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// A browser that starts on a busy machine needs long.
constexpr std::chrono::seconds time_to_connect{90};

struct Pixels {
  std::uint32_t width, height;
};

Pixels size_in_pixels(const RenderOptions& options) {
  constexpr double millimetres_of_inch = 25.4;
  const double scale = options.size.is_in_millimetres ? options.dpi / millimetres_of_inch : 1;
  const auto pixels = [&](double length) { return std::round(scale * length); };
  const double width = pixels(options.size.width), height = pixels(options.size.height);
  if (!(std::min(width, height) >= 1) || std::max(width, height) > most_pixels)
    fail(
        "--size: the pictures would have {:.0f} x {:.0f} pixels; choose a size from 1 to {} "
        "pixels a side, or "
        "another --dpi",
        width, height, most_pixels);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

/// What the page shall draw (viewer/PROTOCOL.md).
std::string job_of(const RenderOptions& options, Pixels size) {
  viewer::JsonText json;
  json.begin_object();
  json.key("frames");
  if (options.frames) {
    json.begin_array();
    for (const std::uint64_t number : {options.frames->first, options.frames->last, options.frames->every})
      json.value(number);
    json.end_array();
  } else {
    json.null();
  }
  json.member("width", size.width);
  json.member("height", size.height);
  json.member("dpi", options.dpi);
  json.member("format", options.is_svg ? "svg" : "png");
  json.member("background", options.background);
  json.member("theme", options.theme);
  json.member("legend", options.legend);
  json.member("scale_bar", options.scale_bar);
  json.member("colour_bar", options.colour_bar);
  json.key("plot");
  if (options.plot.empty())
    json.null();
  else
    json.value(std::string_view(options.plot));
  json.end_object();
  return std::string(json.text());
}

/// A result of the page: a JSON object of the length that the first four bytes say, and the content of a
/// file.
struct PageResult {
  viewer::JsonValue head;
  std::string_view content;
};

PageResult parse_result(std::span<const std::byte> bytes) {
  std::uint32_t length = 0;
  if (bytes.size() >= sizeof length) std::memcpy(&length, bytes.data(), sizeof length);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::size_t fault = 0;
  std::optional<viewer::JsonValue> head;
  if (length > 0 && length <= bytes.size() - sizeof length)
    head = viewer::parse_json(text.substr(sizeof length, length), fault);
  if (!head) fail("the page sent a result that cannot be read; this is a fault of supple");
  return {std::move(*head), text.substr(sizeof length + length)};
}

/// One run: takes the pictures from the page and writes them.
class Run {
 public:
  Run(const RenderOptions& options, PictureNames names, Pixels size)
      : options_(options),
        names_(std::move(names)),
        size_(size),
        frames_(options.frames ? options.frames->count() : 1),
        planned_(options.plot.empty() ? frames_ : 1),
        progress_(frames_, !options.quiet, options.plot.empty() ? "picture" : "frame") {}

  int go(viewer::SceneView show, const std::string& page, const std::string& program) {
    viewer::Server server(
        viewer::Session(std::move(show), {.history_bytes = 1}),  // speeds need the step before
        {.page = page,
         .drawing = {[this](std::span<const std::byte> result) { take(parse_result(result)); },
                     [this] { has_left_ = true; }}});
    const Interruption interruption;
    Browser browser(program, options_.uses_graphics_card);
    browser.open(server.url());
    const auto start = Clock::now();
    server.run([&] {
      if (interruption.signal() != 0 || has_ended_) return true;
      if (const auto words = browser.end())
        fault_ = fmt::format("{}: the browser has ended{}{}", program, words->empty() ? "" : ": ", *words);
      else if (has_left_)
        fault_ = "the page has ended; the scene or the pictures may be too large for the browser";
      else if (!has_begun_ && Clock::now() - start > time_to_connect)
        fault_ = fmt::format("{}: the browser did not open the page within {} s; is it a Chromium?", program,
                             time_to_connect.count());
      return !fault_.empty();
    });
    if (interruption.signal() != 0)
      return report_end(interruption, std::nullopt,
                        fmt::format("{} of {}", taken_, counted(planned_, "picture")), exit_done);
    if (!fault_.empty()) throw Error(fault_ + saved_so_far());
    if (!options_.quiet)
      fmt::print("{}: {}, {} x {} pixels\n", one_line(options_.output), counted(taken_, "picture"),
                 size_.width, size_.height);
    return exit_done;
  }

 private:
  void take(const PageResult& result) {
    has_begun_ = true;
    const viewer::JsonValue* const kind = result.head.find("kind");
    const std::string word = kind ? kind->text : "";
    if (word == "picture") return write(result);
    if (word == "step") {
      ++passed_;
      progress_.update(passed_, fmt::format("frame {} of {}", passed_, frames_));
    }
    if (word == "end") has_ended_ = true;
    if (word == "failure") {
      const viewer::JsonValue* const message = result.head.find("message");
      fault_ = message && !message->text.empty() ? message->text : "the page has failed";
    }
  }

  void write(const PageResult& result) {
    const viewer::JsonValue* const step = result.head.find("step");
    viewer::replace_file(names_.of(step ? static_cast<std::uint64_t>(step->integer) : 0), result.content);
    ++taken_;
    if (options_.plot.empty()) progress_.update(taken_, fmt::format("picture {} of {}", taken_, planned_));
  }

  std::string saved_so_far() const {
    return taken_ == 0 || !options_.plot.empty()
               ? ""
               : fmt::format("; {} of {} are saved", taken_, counted(planned_, "picture"));
  }

  const RenderOptions& options_;
  PictureNames names_;
  Pixels size_;
  std::uint64_t frames_, planned_;
  std::uint64_t taken_ = 0, passed_ = 0;
  Progress progress_;
  bool has_begun_ = false, has_ended_ = false, has_left_ = false;
  std::string fault_;
};

void check_frames(const RenderOptions& options, const viewer::SceneView& show, const PictureNames& names) {
  const bool is_plot = !options.plot.empty();
  if (is_plot && !show.frames && !options.frames)
    fail("--plot: a simulation has no end; choose its steps, such as --frames 0-100");
  if (is_plot && names.has_number())
    fail("--output: {}: a plot is one picture; write a name without %", options.output);
  if (!options.frames) return;
  if (!is_plot && !names.has_number() && options.frames->count() > 1)
    fail(
        "--output: {}: the pictures of several frames need different names; write %04d "
        "where the number of the frame shall be",
        options.output);
  if (show.frames && options.frames->last >= show.frames->count())
    fail("--frames: {} is no frame of {}, which has the frames 0 to {}", options.frames->last,
         options.inputs.front(), show.frames->count() - 1);
}

}  // namespace

int run_render(const RenderOptions& options) {
  check_viewer();
  const std::string program = find_browser(options.browser);
  const PictureNames names(options.output);
  const Pixels size = size_in_pixels(options);
  const std::string page = viewer::page_with_json(page_of(options), "supple-job", job_of(options, size));
  viewer::SceneView show = read_scene_view(options, {"--output", names.of(0)});
  check_frames(options, show, names);
  print_warnings(show);
  warn_of_missing_threads(options.scene.threads);
  Run run(options, names, size);
  return run.go(std::move(show), page, program);
}

}  // namespace supple::cli
