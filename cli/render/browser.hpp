#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

namespace supple::cli {

/// The path of a Chromium: `given` when it is not empty, else that in the environment variable
/// SUPPLE_CHROMIUM, else the first in PATH. Throws `Error` when there is none, with the name of the Debian
/// package.
std::string find_browser(const std::string& given);

/// A Chromium without a window. It has a profile of its own in the folder of temporary files, and ends when
/// this process ends in any way.
class Browser {
 public:
  /// Starts the program. Without `uses_graphics_card` it draws in software, which gives the same pictures on
  /// every machine. Throws `Error` when it cannot be started.
  Browser(const std::string& program, bool uses_graphics_card);
  /// Ends the browser with all its processes and removes its files.
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens an address, which no other user can see.
  void open(const std::string& url);
  /// What the browser wrote last, when it has ended by itself.
  std::optional<std::string> end();

 private:
  bool has_ended();
  bool ends_within(double seconds);
  std::string last_words() const;

  std::filesystem::path profile_;
  pid_t process_ = 0;  ///< also the number of its group
  bool has_ended_ = false;
  int control_ = -1;  ///< the browser ends when this socket is closed
};

}  // namespace supple::cli
