#include "render/browser.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "base/text.hpp"
#include "supple/utf8.hpp"

extern char** environ;

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

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

Browser::Browser(const std::string& program, bool uses_graphics_card) : profile_(make_profile()) {
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
  const int fault = posix_spawn(&process_, program.c_str(), &actions, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (fault == 0) return;
  close(control_);
  std::error_code ignored;
  fs::remove_all(profile_, ignored);
  fail("{}: cannot be started: {}", program, std::strerror(fault));
}

Browser::~Browser() {
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

void Browser::open(const std::string& url) {
  // The arguments of a program are visible to all users, but not what it reads. The address contains a token.
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

std::optional<std::string> Browser::end() {
  if (!has_ended()) return std::nullopt;
  return last_words();
}

bool Browser::has_ended() {
  has_ended_ = has_ended_ || waitpid(process_, nullptr, WNOHANG) == process_;
  return has_ended_;
}

bool Browser::ends_within(double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!has_ended()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

/// The last line that is not empty.
std::string Browser::last_words() const {
  std::ifstream file(profile_ / "messages.txt");
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return one_line(last);
}

}  // namespace supple::cli
