#pragma once

#include <filesystem>
#include <string>

namespace supple::cli {

/// Opens a secret address in the user's browser. Everyone on the machine can list the arguments of a program.
/// So the browser gets a file that only the user can read and that leads to the address. The file exists as
/// long as this object.
class BrowserVisit {
 public:
  /// Does nothing without a screen or a browser. Prints a warning when the file cannot be written. The
  /// address must not need escaping in HTML.
  explicit BrowserVisit(const std::string& url);
  ~BrowserVisit();
  BrowserVisit(const BrowserVisit&) = delete;
  BrowserVisit& operator=(const BrowserVisit&) = delete;

 private:
  std::filesystem::path page_;  ///< empty without a page
};

}  // namespace supple::cli
