#include "commands/commands.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/interruption.hpp"
#include "base/progress.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "export/page_file.hpp"
#include "render/picture_names.hpp"
#include "server/server.hpp"
#include "session/messages/json_text.hpp"
#include "session/messages/json_value.hpp"
#include "supple/error.hpp"
#include "view/build_scene_view.hpp"
#include "view_file/view_file.hpp"

extern char** environ;

namespace supple::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A browser that starts on a busy machine needs long.
constexpr std::chrono::seconds time_to_connect{90};

/// The shell has no windows and starts in a third of the time.
constexpr std::array names_of_browsers{"chromium-headless-shell", "chromium", "chromium-browser",
                                       "google-chrome", "google-chrome-stable"};

/// The browser reads commands from this file and writes answers to the next one (--remote-debugging-pipe).
constexpr int commands_of_browser = 3;
constexpr int answers_of_browser = 4;

std::string value_of(const char* variable) {
  const char* const value = std::getenv(variable);
  return value ? value : "";
}

bool is_program(const fs::path& path) {
  std::error_code fault;
  return fs::is_regular_file(path, fault) && access(path.c_str(), X_OK) == 0;
}

std::string checked(const std::string& path, const char* source) {
  if (!is_program(path)) fail("{}: {}: it is not a program; give the path of a Chromium", source, path);
  return path;
}

fs::path make_profile() {
  std::error_code fault;
  std::string name = fs::temp_directory_path(fault) / "supple-browser-XXXXXX";
  if (fault || mkdtemp(name.data()) == nullptr)
    fail("{}: cannot make a folder for the browser: {}; set TMPDIR to a writable folder", name,
         std::strerror(fault ? fault.value() : errno));
  return name;
}

std::vector<std::string> arguments_of(const std::string& program, const fs::path& profile,
                                      bool uses_graphics_card) {
  std::vector<std::string> arguments{program,
                                     "--headless",
                                     "--remote-debugging-pipe",
                                     "--user-data-dir=" + profile.string(),
                                     "--no-first-run",
                                     "--no-default-browser-check",
                                     "--disable-extensions",
                                     "--disable-sync",
                                     "--disable-background-networking",
                                     "--disable-component-update",
                                     "--disable-dev-shm-usage",
                                     "--disable-background-timer-throttling",
                                     "--disable-renderer-backgrounding",
                                     "--force-color-profile=srgb",
                                     "--ignore-gpu-blocklist"};
  if (!uses_graphics_card)
    for (const char* flag :
         {"--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing"})
      arguments.emplace_back(flag);
  if (geteuid() == 0) arguments.emplace_back("--no-sandbox");  // its sandbox refuses root
  return arguments;
}

/// The path of a Chromium: `given` when it is not empty, else that in the environment variable
/// SUPPLE_CHROMIUM, else the first in PATH. Throws `Error` when there is none, with the name of the Debian
/// package.
std::string find_browser(const std::string& given) {
  if (!given.empty()) return checked(given, "--browser");
  if (const std::string path = value_of("SUPPLE_CHROMIUM"); !path.empty())
    return checked(path, "SUPPLE_CHROMIUM");
  const std::string path = value_of("PATH");
  for (const char* name : names_of_browsers) {
    std::istringstream folders(path);
    for (std::string folder; std::getline(folders, folder, ':');)
      if (is_program(fs::path(folder) / name)) return fs::path(folder) / name;
  }
  fail(
      "there is no Chromium, which draws the pictures; install it (Debian: apt-get install "
      "chromium-headless-shell, or chromium), or give its path by --browser or SUPPLE_CHROMIUM");
}

/// A Chromium without a window. It has a profile of its own in the folder of temporary files, and ends when
/// this process ends in any way.
class Browser {
 public:
  /// Starts the program. Without `uses_graphics_card` it draws in software, which gives the same pictures on
  /// every machine. Throws `Error` when it cannot be started.
  Browser(const std::string& program, bool uses_graphics_card) : profile_(make_profile()) {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      fail("cannot make a socket for the browser: {}", std::strerror(errno));
    control_ = ends[0];
    std::vector<std::string> arguments = arguments_of(program, profile_, uses_graphics_card);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], commands_of_browser);
    const auto redirect = [&](int file, const char* path, int mode) {
      posix_spawn_file_actions_addopen(&actions, file, path, mode, S_IRUSR | S_IWUSR);
    };
    redirect(answers_of_browser, "/dev/null", O_WRONLY);
    redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
    redirect(STDOUT_FILENO, "/dev/null", O_WRONLY);
    redirect(STDERR_FILENO, (profile_ / "messages.txt").c_str(), O_WRONLY | O_CREAT | O_APPEND);
    // A group of its own: Ctrl-C reaches only this program, which then ends the browser.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int fault =
        posix_spawn(&process_, program.c_str(), &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (fault == 0) return;
    close(control_);
    std::error_code ignored;
    fs::remove_all(profile_, ignored);
    fail("{}: cannot be started: {}", program, std::strerror(fault));
  }

  /// Ends the browser with all its processes and removes its files.
  ~Browser() {
    close(control_);
    const bool has_gone = ends_within(3);
    kill(-process_, SIGKILL);  // also helpers that a browser left behind
    if (!has_gone) waitpid(process_, nullptr, 0);
    std::error_code fault;
    for (int i = 0; i < 50 && fs::exists(profile_, fault); ++i) {
      fs::remove_all(profile_, fault);
      if (fault) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens an address, which no other user can see.
  void open(const std::string& url) {
    // The arguments of a program are visible to all users, but not what it reads. The address contains a
    // token.
    std::string command = R"({"id":1,"method":"Target.createTarget","params":{"url":")" + url + "\"}}";
    command += '\0';
    std::string_view rest = command;
    while (!rest.empty()) {
      const ssize_t count = send(control_, rest.data(), rest.size(), MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return;  // it has ended, which `end` reports
      rest.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  /// What the browser wrote last, when it has ended by itself.
  std::optional<std::string> end() {
    if (!has_ended()) return std::nullopt;
    return last_words();
  }

 private:
  bool has_ended() {
    has_ended_ = has_ended_ || waitpid(process_, nullptr, WNOHANG) == process_;
    return has_ended_;
  }

  bool ends_within(double seconds) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!has_ended()) {
      if (std::chrono::steady_clock::now() >= deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }

  /// The last line that is not empty.
  std::string last_words() const {
    std::ifstream file(profile_ / "messages.txt");
    std::string last;
    for (std::string line; std::getline(file, line);)
      if (!line.empty()) last = line;
    return one_line(last);
  }

  std::filesystem::path profile_;
  pid_t process_ = 0;  ///< also the number of its group
  bool has_ended_ = false;
  int control_ = -1;  ///< the browser ends when this socket is closed
};

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
        "--size: the pictures would have {:.0f} x {:.0f} pixels; choose a size from 1 to {} pixels a side, "
        "or another --dpi",
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
