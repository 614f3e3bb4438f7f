#pragma once

#include <filesystem>
#include <string>

namespace supple::viewer {

/// Opens a secret address in the user's browser. Everyone on the machine can list the arguments of a program.
/// So the browser gets a file that only the user can read and that leads to the address. The file exists as
/// long as this object.
class BrowserVisit {
 public:
  /// Does nothing without a screen or a browser, or when the file cannot be written. The address must not
  /// need escaping in HTML.
  explicit BrowserVisit(const std::string& url);
  ~BrowserVisit();
  BrowserVisit(const BrowserVisit&) = delete;
  BrowserVisit& operator=(const BrowserVisit&) = delete;

  /// Why the file could not be written; empty when it was.
  const std::string& problem() const { return problem_; }

 private:
  std::filesystem::path page_;  ///< empty without a page
  std::string problem_;
};

}  // namespace supple::viewer
