#include "browser_visit.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>

extern char** environ;

namespace supple::viewer {
namespace {

#ifdef __APPLE__
constexpr const char* opener = "open";

bool has_screen() {
  return true;
}
#else
constexpr const char* opener = "xdg-open";

bool has_screen() {
  const auto is_set = [](const char* name) {
    const char* const value = std::getenv(name);
    return value && *value;
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}
#endif

namespace fs = std::filesystem;

/// The folder for temporary files of this user, or else the folder for those of all users.
fs::path folder_of_pages() {
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime && *runtime == '/' && access(runtime, W_OK) == 0) return runtime;
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  return error ? "/tmp" : temporary;
}

bool write_text(int file, const std::string& text) {
  std::FILE* const stream = fdopen(file, "w");
  if (!stream) {
    close(file);
    return false;
  }
  const bool written = std::fputs(text.c_str(), stream) >= 0;
  return std::fclose(stream) == 0 && written;
}

/// Writes a page that leads to an address, as a new file of mode 0600. Returns an empty path, and the
/// problem, when that fails.
fs::path write_page(const std::string& url, std::string& problem) {
  const std::string text =
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Supple</title>\n"
      "<meta name=\"referrer\" content=\"no-referrer\">\n"
      "<meta http-equiv=\"refresh\" content=\"0; url=" +
      url +
      "\">\n"
      "<p><a href=\"" +
      url + "\">To the page of Supple</a></p>\n</html>\n";
  constexpr std::string_view ending = ".html";
  std::string name = folder_of_pages() / "supple-XXXXXX";
  name += ending;
  const int file = mkostemps(name.data(), static_cast<int>(ending.size()), O_CLOEXEC);
  if (file >= 0 && write_text(file, text)) return name;
  problem = name + ": cannot write the page that leads the browser to the address: " + std::strerror(errno) +
            "; open it yourself";
  if (file >= 0) unlink(name.c_str());
  return {};
}

/// Does nothing when there is no program that opens the page.
void open_in_browser(const fs::path& page) {
  // Discards the messages that browsers write to the terminal.
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // A separate process group: Ctrl-C ends this program, not the browser.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::string program = opener, argument = page;
  const std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
  pid_t child = 0;
  // Nothing waits for it: what is left of it when it ends is small, and goes when this program ends.
  posix_spawnp(&child, opener, &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
}

}  // namespace

BrowserVisit::BrowserVisit(const std::string& url) {
  if (!has_screen()) return;
  page_ = write_page(url, problem_);
  if (!page_.empty()) open_in_browser(page_);
}

BrowserVisit::~BrowserVisit() {
  if (!page_.empty()) unlink(page_.c_str());
}

}  // namespace supple::viewer
