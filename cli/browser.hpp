#pragma once

#include <filesystem>
#include <string>

namespace supple::cli {

/// Leads the user's browser to an address that is a secret. The arguments of a program can be listed by
/// everyone on the machine, so the browser is not given the address but a file that only the user may read,
/// from which it goes there by itself. The file is there while this lives.
class BrowserVisit {
 public:
  /// Does nothing where there is no screen or no browser, and warns where no file can be written. The address
  /// must be fit for HTML as it is.
  explicit BrowserVisit(const std::string& url);
  ~BrowserVisit();
  BrowserVisit(const BrowserVisit&) = delete;
  BrowserVisit& operator=(const BrowserVisit&) = delete;

 private:
  std::filesystem::path page_;  ///< empty when there is none
};

}  // namespace supple::cli
