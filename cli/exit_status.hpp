#pragma once

namespace supple::cli {

/// Scripts rely on these values.
enum ExitStatus : int {
  exit_done = 0,
  exit_contact = 1,      ///< --fail-on-contact, and something touches
  exit_differ = 1,       ///< of diff
  exit_unusable = 2,     ///< usage or input error, told in one line on standard error; or motion that blew up
  exit_differences = 3,  ///< --verify, and brute force disagrees; or a false answer to a query
  exit_interrupted = 128,  ///< plus the number of the signal that ended a simulation early
};

}  // namespace supple::cli
